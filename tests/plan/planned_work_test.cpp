// SPDX-License-Identifier: Apache-2.0
#include "plan/planners.h"

#include "cpu_alone.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

struct Case {
    explicit Case(nlohmann::json document) : scene(read_scene(document, "s")) {
        const Volume volume = load_volume(scene);
        facts = measure(scene, volume, measure_bricks(volume));
        plan = make_plan(scene, facts, cpu_alone(), {});
    }
    Scene scene;
    Facts facts;
    Plan plan;
};

// Returns a ramp whose values rise along the picture's rows and whose box fills a view of 10 slabs.
// Values below `first_visible` show nothing; if it is 0, all values show.
Case ramp_case(double first_visible, double extinction) {
    nlohmann::json document = minimal_scene();
    document["volume"] = {{"generate", "ramp"}, {"size", {65, 9, 9}}};
    document["render"]["slice"]["samples"] = 10;
    const Scene scene = read_scene(document, "s");
    const Grid grid = load_volume(scene).grid();
    const glm::dvec3 lo = grid.to_world(grid.index_min()), hi = grid.to_world(grid.index_max());
    const glm::dvec3 middle = 0.5 * (lo + hi);
    document["camera"] = {{"projection", "orthographic"},
                          {"height", hi.y - lo.y},
                          {"eye", {middle.x, middle.y, hi.z + 10}},
                          {"center", {middle.x, middle.y, middle.z}},
                          {"up", {0, 1, 0}}};
    const double ratio = (hi.x - lo.x) / (hi.y - lo.y);
    document["image"] = {{"width", std::lround(16 * ratio)}, {"height", 16}};
    const auto point = [](double value, double shown) {
        return nlohmann::json::object({{"value", value}, {"extinction", shown}});
    };
    auto points = nlohmann::json::array();
    if (first_visible > 0) points.push_back(point(first_visible, 0));
    points.push_back(point(first_visible + 1, extinction));
    document["transfer_function"]["points"] = points;
    document["render"]["slice"]["classification"] = "post";
    return Case(document);
}

double saved(const Plan& plan, const std::string& name) {
    for (const Omission& omission : plan.omitted) {
        if (omission.name == name) return omission.saves.segments;
    }
    return 0;
}

// If a box fills the picture and all of it shows, the work is every slab of every pixel.
TEST(PlannedWork, IsAllSlabsOfAFullPicture) {
    const Case faint = ramp_case(0, 1e-3);
    const double all = 10.0 * faint.scene.width * faint.scene.height;
    EXPECT_DOUBLE_EQ(faint.plan.work.segments, all);
    EXPECT_EQ(faint.plan.work.passes, 1);
    EXPECT_EQ(saved(faint.plan, "empty_space"), 0);
}

// Values rise from 0 to 255 along the picture, and show in its last quarter, so three quarters are
// saved. The tolerances are for a brick at the border, 4 of 64 cells, and for one of the 32 rays of
// a row, which may lie on either side.
TEST(PlannedWork, EmptySpaceSavesItsShare) {
    const Case sparse = ramp_case(191, 1e-3);
    const double all = 10.0 * sparse.scene.width * sparse.scene.height;
    EXPECT_NEAR(sparse.plan.work.segments, 0.25 * all, (4. / 64 + 1. / 32) * all);
    EXPECT_DOUBLE_EQ(saved(sparse.plan, "empty_space") + sparse.plan.work.segments, all);
}

// If everything is nearly opaque, rays end in the first of the steps in which facts follow them.
TEST(PlannedWork, RaysThatEndEarlySaveTheRest) {
    const Case opaque = ramp_case(0, 1e6);
    const double all = 10.0 * opaque.scene.width * opaque.scene.height;
    EXPECT_LE(opaque.plan.work.segments, 0.2 * all);
    EXPECT_DOUBLE_EQ(saved(opaque.plan, "early_termination") + opaque.plan.work.segments, all);
}

// The stated saving of an omission is the work of a plan without it minus that of the plan.
TEST(PlannedWork, SavingsAreDifferencesOfPlans) {
    const Case sparse = ramp_case(127, 1e6);
    ASSERT_GE(sparse.plan.omitted.size(), 3U);
    for (const Omission& omission : sparse.plan.omitted) {
        OmissionSwitch keeping;
        keeping.kept = {omission.name};
        const Plan other = make_plan(sparse.scene, sparse.facts, cpu_alone(), keeping);
        EXPECT_EQ((other.work - sparse.plan.work).amounts(), omission.saves.amounts())
            << omission.name;
    }
}

TEST(PlannedWork, TetsThatShowNothingAreSaved) {
    MeshFacts facts;
    facts.tets = 100;
    facts.transparent_tets = 60;
    facts.parts = 70;
    Scene scene = read_scene(minimal_scene(), "s");
    Plan plan;
    plan.method = Method::project;
    plan.project.source = SegmentSource::parts;
    plan.omitted = {{"transparent_tets", "because", {}}};
    add_savings(plan, scene, facts);
    EXPECT_EQ(plan.work.tets, 70);
    EXPECT_EQ(plan.work.ordered, 100);
    EXPECT_EQ(plan.omitted[0].saves.tets, 60);
    EXPECT_EQ(to_text(plan.omitted[0].saves), "60 tets");
}

}  // namespace
}  // namespace lamina

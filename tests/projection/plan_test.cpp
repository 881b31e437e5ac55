// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "projection_fixture.h"
#include "support/expect_error.h"
#include "support/split_box.h"

namespace lamina {
namespace {

Plan plan_for(const TransferFunction& transfer_function,
              const std::function<void(Scene&)>& change = {}) {
    const SceneMesh mesh = scene_mesh(
        test::split_box(2, 200, .1, [](const glm::dvec3& p) { return p.x * p.y + .3 * p.z; }));
    Scene scene = projection_scene(transfer_function, 32, 32);
    scene.camera->eye = {2, 2, 2};
    scene.camera->center = {.5, .5, .5};
    scene.camera->up = {0, 1, 0};
    if (change) change(scene);
    Capabilities capabilities;
    capabilities.max_texture_size = 1024;
    return plan_of(mesh, scene, capabilities);
}

bool leaves_out(const Plan& plan, const std::string& name) {
    return std::ranges::any_of(plan.omitted, [&](const Omission& o) { return o.name == name; });
}

const TransferFunction colored =
    TransferFunction::linear({knot(0, {1, 0, 0}, .2), knot(1, {0, 0, 1}, .9)});

TEST(ProjectPlan, UsesWhatTheTransferFunctionNeeds) {
    const Plan constant = plan_for(TransferFunction::linear({knot(0, {1, 0, 0}, .2)}));
    EXPECT_EQ(constant.project.source, SegmentSource::constant);
    EXPECT_TRUE(leaves_out(constant, "scalars"));
    EXPECT_EQ(constant.project.visibility, OrderMethod::none);
    EXPECT_TRUE(leaves_out(constant, "order"));
    const Plan single =
        plan_for(TransferFunction::linear({knot(0, {1, 0, 0}, .2), knot(1, {1, 0, 0}, .9)}));
    EXPECT_EQ(single.project.source, SegmentSource::parts);
    EXPECT_EQ(single.project.trial_error.segments, 0);
    EXPECT_TRUE(leaves_out(single, "color"));
    const Plan both = plan_for(colored);
    EXPECT_EQ(both.project.source, SegmentSource::parts);
    EXPECT_EQ(both.project.visibility, OrderMethod::mpvo);  // a box is convex
    EXPECT_GT(both.project.trial_error.segments, 0);
    EXPECT_LE(both.project.trial_error.segments,
              .008);  // 3e-5 of the weights, times the change of colour
    const Plan hidden = plan_for(TransferFunction::linear({knot(0, {1, 1, 1}, 0)}));
    EXPECT_TRUE(hidden.project.nothing_visible);
}

TEST(ProjectPlan, ManyPointsAndTrianglesUseTables) {
    std::vector<TransferKnot> knots;
    for (int i = 0; i < 200; ++i) {
        const double place = i / 199.0;
        knots.push_back(knot(place, {place, 1 - place, .5 + .5 * std::sin(60 * place)}, place));
    }
    // Each of few tets may fill the picture, so the integral is exact, at any cost.
    EXPECT_EQ(plan_for(TransferFunction::linear(knots)).project.source, SegmentSource::analytic);
    const SceneMesh large = scene_mesh(test::kuhn_box(
        {12, 12, 12}, [](const glm::dvec3& p) { return std::fmod(.3 * p.x + .7 * p.y, 1.0); }));
    Scene wanted = projection_scene(TransferFunction::linear(knots), 32, 32);
    wanted.camera->eye = {20, 20, 20};
    wanted.camera->center = {6, 6, 6};
    Capabilities capabilities;
    capabilities.max_texture_size = 1024;
    const Plan many = plan_of(large, wanted, capabilities);
    EXPECT_EQ(many.project.source, SegmentSource::cut_table);
    EXPECT_LE(many.project.trial_error.segments,
              .4);  // most_segment_error over sampling_margin: .5 / 1.25
    const Plan triangles = plan_for(
        colored, [](Scene& scene) { scene.project.geometry = ProjectGeometry::triangles; });
    EXPECT_EQ(triangles.project.source, SegmentSource::cut_table);
}

TEST(ProjectPlan, LinearInterpolationUsesTriangles) {
    EXPECT_EQ(plan_for(colored).project.geometry, ProjectGeometry::silhouette);
    for (const auto& change : {std::function<void(Scene&)>([](Scene& scene) {
                                   scene.project.interpolation = Interpolation::linear;
                               }),
                               std::function<void(Scene&)>(
                                   [](Scene& scene) { scene.project.coloring = Coloring::vertex; }),
                               std::function<void(Scene&)>([](Scene& scene) {
                                   scene.project.coloring = Coloring::attenuation;
                               })}) {
        EXPECT_EQ(plan_for(colored, change).project.geometry, ProjectGeometry::triangles);
    }
}

// An interpolated opacity belongs to no depth by which it could be divided.
TEST(ProjectPlan, VertexColorsAreInterpolatedInThePicture) {
    const Plan plan =
        plan_for(colored, [](Scene& scene) { scene.project.coloring = Coloring::vertex; });
    EXPECT_EQ(plan.project.interpolation, Interpolation::linear);
}

// Vertex and attenuation mix colours of visible scalars with those of transparent ones, so one
// colour needs that these are equal, too.
TEST(ProjectPlan, MixedColorsCountAsOneOnlyIfAllAreEqual) {
    const auto hidden = [](const glm::dvec3& color) {
        return TransferFunction::linear(
            {knot(0, color, 0), knot(.5, color, 0), knot(.5, {1, 0, 0}, 0), knot(1, {1, 0, 0}, 1)});
    };
    for (const Coloring coloring :
         {Coloring::vertex, Coloring::attenuation, Coloring::preintegrated, Coloring::analytic}) {
        const auto colored_by = [&](Scene& scene) { scene.project.coloring = coloring; };
        const bool mixed = coloring == Coloring::vertex || coloring == Coloring::attenuation;
        for (const char* name : {"order", "color"}) {
            EXPECT_EQ(leaves_out(plan_for(hidden({0, 1, 0}), colored_by), name), !mixed);
            EXPECT_TRUE(leaves_out(plan_for(hidden({1, 0, 0}), colored_by), name));
        }
    }
}

TEST(ProjectPlan, DitherNeedsCodes) {
    const auto dithered = [](Scene& scene) { scene.project.dither = ProjectDither::after_blend; };
    const Plan plan = plan_for(colored, dithered);
    EXPECT_EQ(plan.project.dither, ProjectDither::none);
    EXPECT_TRUE(leaves_out(plan, "dither"));
    const Plan fixed8 = plan_for(colored, [&](Scene& scene) {
        dithered(scene);
        scene.target = Target::fixed8;
    });
    EXPECT_EQ(fixed8.project.blending, Blending::registers);
}

// OpenGL's compute shaders composite codes, and draw no triangles.
TEST(ProjectPlan, CodesOfOpenGlNeedSilhouettes) {
    const auto draw = [](ProjectDither dither, Coloring coloring, ProjectGeometry geometry) {
        return plan_for(colored, [&](Scene& scene) {
            scene.target = dither == ProjectDither::none ? Target::emulated : Target::fixed8;
            scene.project.dither = dither;
            scene.project.coloring = coloring;
            scene.project.geometry = geometry;
        });
    };
    using enum ProjectDither;
    EXPECT_EQ(draw(none, Coloring::preintegrated, ProjectGeometry::silhouette).project.blending,
              Blending::registers);
    expect_error([&] { draw(none, Coloring::vertex, ProjectGeometry::triangles); },
                 {"render.target", "emulated", "triangles", "--context cpu"});
    expect_error([&] { draw(after_blend, Coloring::preintegrated, ProjectGeometry::triangles); },
                 {"render.project.dither", "after_blend", "triangles", "--context cpu"});
    // The blending unit composites what was dithered before.
    EXPECT_EQ(draw(alpha, Coloring::vertex, ProjectGeometry::triangles).project.blending,
              Blending::native);
}

TEST(ProjectPlan, TreesNeedFixedNodesAndOneColor) {
    const TransferFunction grey =
        TransferFunction::linear({knot(0, {.5, .5, .5}, .2), knot(1, {.5, .5, .5}, .9)});
    const auto tree = [](Scene& scene) {
        scene.target = Target::fixed8;
        scene.project.tree = TreeSettings{.factors = {4, 4}, .nodes = NodeArithmetic::fixed};
    };
    const Plan plan = plan_for(grey, tree);
    EXPECT_EQ(plan.project.tree, (std::vector{4, 4}));
    EXPECT_TRUE(plan.project.scattered);
    EXPECT_TRUE(leaves_out(plan, "order"));
    const Plan ordered = plan_for(grey, [&](Scene& scene) {
        tree(scene);
        scene.project.order = ProjectOrder::exact;
    });
    EXPECT_FALSE(ordered.project.scattered);
    EXPECT_EQ(ordered.project.visibility, OrderMethod::exact);

    const auto refused = [&](const TransferFunction& transfer_function, const auto& change,
                             std::initializer_list<std::string> parts) {
        expect_error(
            [&] {
                plan_for(transfer_function, [&](Scene& scene) {
                    scene.file = "s.json";
                    tree(scene);
                    change(scene);
                });
            },
            parts);
    };
    refused(colored, [](Scene&) {},
            {"s.json: render.project.tree.nodes: found \"fixed\"", "one colour"});
    refused(grey, [](Scene& scene) { scene.target = Target::float32; },
            {"s.json: render.project.tree.nodes: found \"fixed\"", "\"float32\"", "fixed8"});
    refused(grey, [](Scene& scene) { (*scene.project.tree)->nodes = NodeArithmetic::shader; },
            {"s.json: render.project.tree.nodes: found \"shader\"", "\"fixed\""});
    refused(grey, [](Scene& scene) { scene.project.tree = automatic; },
            {"s.json: render.project.tree: found \"auto\"", "\"factors\""});
    refused(grey, [](Scene& scene) { scene.project.interpolation = Interpolation::linear; },
            {"s.json: render.project.tree: found", "\"linear\"", "perspective"});
    refused(grey,
            [](Scene& scene) { scene.project.table = TableSettings{.store = TableStore::opacity}; },
            {"s.json: render.project.table.store: found \"opacity\"", "\"mean_extinction\""});
}

TransferFunction two_steps() {
    return TransferFunction::linear({knot(.4, {1, 1, 1}, 0), knot(.4, {1, 1, 1}, 2),
                                     knot(1.3, {1, 1, 1}, 2), knot(1.3, {1, 1, 1}, 0)});
}

// The error of a table that a scene asks for is large on few rays: all of a small picture are
// tried, and more than usual of a large one, whose figure has a larger margin.
TEST(ProjectPlan, TriesMoreRaysIfTheSceneAsksForATable) {
    const SceneMesh mesh = scene_mesh(test::split_box(
        7, 40, .1, [](const glm::dvec3& p) { return p.x + .4 * p.y * p.z + .3 * p.z; }));
    Scene scene = projection_scene(two_steps(), 120, 90);
    scene.camera->eye = {1.3, 1.7, 2.1};
    scene.camera->center = {.5, .5, .5};
    scene.camera->up = {0, 1, 0};
    const MeshFacts usual = measure(scene, mesh);
    scene.project.table = TableSettings{.scalar = 32, .length = 4};
    const MeshFacts small = measure(scene, mesh);
    EXPECT_EQ(small.pixels_a_trial_ray, 1);
    EXPECT_GT(small.trial_rays.size(), 5 * usual.trial_rays.size());
    EXPECT_GT(usual.pixels_a_trial_ray, 10);
    const Plan plan = make_plan(scene, small, cpu_capabilities(), {});
    const double error =
        image_error(project(mesh, scene, cpu_capabilities()), trace(mesh, scene)).all.linf;
    EXPECT_GT(error, .5);
    EXPECT_LE(error, plan.project.trial_error.segments + plan.project.trial_error.places + .05);

    scene.width = 4000;
    scene.height = 3000;
    MeshFacts large = measure(scene, mesh);
    EXPECT_GT(large.pixels_a_trial_ray, 40);
    // At most 2^18 rays go through pixels.
    EXPECT_LT(large.trial_rays.size(), (1 << 18) + 2 * mesh.mesh.tets().size());
    scene.project.table->scalar = 256;  // whose figure may be stated
    large.pixels_a_trial_ray = 16;
    const ProjectPlan sampled = make_plan(scene, large, cpu_capabilities(), {}).project;
    large.pixels_a_trial_ray = 1;
    const ProjectPlan all = make_plan(scene, large, cpu_capabilities(), {}).project;
    ASSERT_EQ(all.error.kind, ErrorKind::sampled);
    ASSERT_EQ(sampled.error.kind, ErrorKind::sampled);
    // The fourth root of 16 in place of the usual margin, 1.25.
    EXPECT_NEAR(sampled.error.value - all.error.value, .75 * all.trial_error.segments, 1e-9);
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "plan/plan.h"

#include <algorithm>

#include "cpu_alone.h"
#include "plan/planners.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

Capabilities usual_opengl() {
    Capabilities capabilities;
    capabilities.renderer = "test";
    capabilities.max_texture_size = 16384;
    capabilities.max_3d_texture_size = 2048;
    return capabilities;
}

Plan plan_of(const nlohmann::json& document, const Capabilities& capabilities) {
    const Scene scene = read_scene(document, "s");
    const Volume volume = load_volume(scene);
    return make_plan(scene, measure(scene, volume, measure_bricks(volume)), capabilities, {});
}

TEST(Plan, TakesTwoSlabsAVoxelWithoutTrials) {
    nlohmann::json document = with("/render/slice/classification", "post");
    document["camera"] = {{"eye", {0.5, 0.5, 3}}, {"center", {0.5, 0.5, 0.5}}};
    EXPECT_EQ(plan_of(document, usual_opengl()).slice.slabs, 30);  // 15 cells
    document["render"]["slice"]["samples"] = 7;
    EXPECT_EQ(plan_of(document, usual_opengl()).slice.slabs, 7);
}

TEST(Plan, FloatTexturesAreFilteredOnlyWhereThatWasMeasuredExact) {
    Capabilities capabilities = usual_opengl();
    const nlohmann::json post = with("/render/slice/classification", "post");
    EXPECT_EQ(plan_of(post, capabilities).slice.sampling, VolumeSampling::fetch);
    capabilities.exact_float_filter = true;
    EXPECT_EQ(plan_of(post, capabilities).slice.sampling, VolumeSampling::filtered);
    EXPECT_EQ(plan_of(with("/render/slice/classification", "exact"), capabilities).slice.sampling,
              VolumeSampling::fetch);
    EXPECT_EQ(plan_of(with("/render/slice/filter", "hardware"), capabilities).slice.sampling,
              VolumeSampling::hardware);
}

// The trials are as slicing/slab_trials.h makes them: 60 slabs with exact scalars, or 80 with
// filtered ones, keep the goal of an error of 1.
TEST(Plan, TheHardwareFilterSavesFetchesIfItKeepsTheError) {
    Scene scene = read_scene(with("/render/slice/filter", "auto"), "s");
    const Volume volume = load_volume(scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    SampleTrials trials{{{60, .8, 100, 1}}, {{60, 1.1, 100, 1}, {80, .9, 100, 1}}};
    Capabilities gpu = usual_opengl();
    const auto plan_for = [&] { return make_plan(scene, facts, gpu, {}, trials); };
    EXPECT_EQ(plan_for().slice.sampling, VolumeSampling::fetch);
    EXPECT_EQ(plan_for().slice.slabs, 60);
    const double fetches = plan_for().work.fetches;
    gpu.eight_bit_filter = true;
    const Plan plan = plan_for();
    EXPECT_EQ(plan.slice.sampling, VolumeSampling::hardware);
    EXPECT_EQ(plan.slice.slabs, 80);
    EXPECT_EQ(plan.slice.slab_trial->error, .9);
    EXPECT_DOUBLE_EQ(plan.work.fetches, fetches * 80 / (8 * 60));
    EXPECT_NE(explain(plan, facts, gpu).find("one look-up"), std::string::npos);
    scene.slice.filter = Filter::exact;
    EXPECT_EQ(plan_for().slice.slabs, 60);
    scene.slice.filter = automatic;

    trials.hardware.back().error = 1.01;
    EXPECT_EQ(plan_for().slice.sampling, VolumeSampling::fetch);
    // If the scene gives the number of slabs, the trial has the error of the filter alone.
    scene.slice.samples = 60;
    trials.exact.clear();
    trials.hardware = {{60, .5, 100, 1}};
    EXPECT_EQ(plan_for().slice.sampling, VolumeSampling::hardware);
    EXPECT_EQ(plan_for().slice.slabs, 60);
    EXPECT_EQ(plan_for().slice.filter_error, .5);
}

// The cpu engine draws trial pictures, so OpenGL's arithmetic is no part of their error.
TEST(Plan, TrialsOfSlabsDoNotShowTheRoundingsOfOpenGl) {
    Scene scene = read_scene(with("/render/slice/classification", "post"), "s");
    const Volume volume = load_volume(scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const SampleTrials trials{{{64, .8, 100, 1}}, {}};
    const auto error_with = [&](const Capabilities& capabilities) {
        const ErrorFigure error = make_plan(scene, facts, capabilities, {}, trials).error();
        EXPECT_EQ(error.kind, ErrorKind::trials);
        return error.value;
    };
    // Chords are good to 1e-5, and each slab has four roundings of 2^-24.
    EXPECT_NEAR(error_with(usual_opengl()) - error_with(cpu_alone()), 255 * (1e-5 + 64 * 0x1p-22),
                1e-9);
}

// Trials have exact weights if the scene asks for those of texture units: their error is not known.
TEST(Plan, HasNoKnownErrorWithAFilterThatWasNotTried) {
    Scene scene = read_scene(with("/render/slice/classification", "post"), "s");
    const Volume volume = load_volume(scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const auto kind_of = [&](const SampleTrials& trials) {
        Capabilities gpu = usual_opengl();
        gpu.eight_bit_filter = true;
        return make_plan(scene, facts, gpu, {}, trials).error().kind;
    };
    const SampleTrials exact{{{60, .8, 100, 1}}, {}};
    EXPECT_EQ(kind_of(exact), ErrorKind::trials);
    scene.slice.filter = Filter::hardware;
    EXPECT_EQ(kind_of(exact), ErrorKind::unknown);
    scene.slice.filter = automatic;
    EXPECT_EQ(kind_of({{{60, .8, 100, 1}}, {{70, .9, 100, 1}}}), ErrorKind::trials);
}

// A hundredth of the rays' length must be empty with the cpu engine, a fifth with OpenGL.
TEST(Plan, EmptyBricksAreLeaptOverWhereEnoughIsEmpty) {
    Scene scene = read_scene(minimal_scene(), "s");
    const Volume volume = load_volume(scene);
    Facts facts = measure(scene, volume, measure_bricks(volume));
    facts.occupied_share = .5;
    facts.ray_shares.box = .6;
    Capabilities native = usual_opengl();
    native.cpu = true;
    const auto leaps = [&](double empty, const Capabilities& capabilities) {
        facts.ray_shares.occupied = (1 - empty) * facts.ray_shares.box;
        return make_plan(scene, facts, capabilities, {}).slice.occupied_only;
    };
    EXPECT_FALSE(leaps(.005, native));
    EXPECT_TRUE(leaps(.015, native));
    EXPECT_FALSE(leaps(.015, usual_opengl()));
    EXPECT_FALSE(leaps(.19, usual_opengl()));
    EXPECT_TRUE(leaps(.21, usual_opengl()));
}

TEST(Plan, ExceededLimitsOfTheContextAreNamed) {
    Capabilities capabilities = usual_opengl();
    capabilities.max_texture_size = 16;
    expect_error([&] { plan_of(minimal_scene(), capabilities); },
                 {"32 x 24", "at most 16", "test"});
    capabilities = usual_opengl();
    capabilities.max_texture_bytes = 16 * 100;
    expect_error([&] { plan_of(minimal_scene(), capabilities); },
                 {"32 x 24", "at most 100", "test"});
}

// 1500^3 samples of 16 bits are 6.75e9 bytes: 7 textures of 1 GiB or more, or one with 32 GiB.
TEST(Plan, VolumesAreOneTextureWhereTheContextHoldsIt) {
    Grid grid;
    grid.size = {1500, 1500, 1500};
    const auto bricks = [&](const Capabilities& capabilities) {
        return cut_into_bricks(grid, false, 2, capabilities).size();
    };
    EXPECT_GE(bricks(usual_opengl()), 7u);
    Capabilities gpu = usual_opengl();
    gpu.max_texture_bytes = max_texture_bytes_of(std::uint64_t{32} << 30);
    EXPECT_EQ(bricks(gpu), 1u);
    gpu.max_texture_bytes = max_texture_bytes_of(std::uint64_t{16} << 30);
    EXPECT_EQ(bricks(gpu), 2u);
    gpu.max_texture_bytes = max_texture_bytes_of(std::uint64_t{32} << 30);
    gpu.max_3d_texture_size = 1499;
    EXPECT_EQ(bricks(gpu), 8u);
}

TEST(Plan, TexturesHaveAtLeastOneGibibyte) {
    const std::uint64_t gibibyte = std::uint64_t{1} << 30;
    EXPECT_EQ(max_texture_bytes_of(0), gibibyte);
    EXPECT_EQ(max_texture_bytes_of(gibibyte), gibibyte);
    EXPECT_EQ(max_texture_bytes_of(80 * gibibyte), 20 * gibibyte);
}

TEST(Plan, RaysAreDoubleInSoftwareAndForThinBoxes) {
    Capabilities gpu = usual_opengl();
    gpu.software = false;
    EXPECT_TRUE(plan_of(minimal_scene(), usual_opengl()).slice.precise_rays);
    EXPECT_FALSE(plan_of(minimal_scene(), gpu).slice.precise_rays);
    const nlohmann::json ramp = with("/volume", {{"generate", "ramp"}});  // 256 : 4 : 1
    EXPECT_TRUE(plan_of(ramp, gpu).slice.precise_rays);
}

// llvmpipe ends the loops of an invocation after 65535 iterations. With a table a slab takes 2 + 4
// + 4 = 10 iterations or more: with n further knots in one cell of the search, 4 n more.
TEST(Plan, SoftwareDispatchesMarchNoMoreSlabsThanLoopsAllow) {
    nlohmann::json document =
        with("/render/slice", {{"samples", 65536}, {"classification", "preintegrated"}});
    const auto most = [&](const Capabilities& capabilities) {
        const SlicePlan plan = plan_of(document, capabilities).slice;
        EXPECT_EQ(plan.tree.value().factors, std::vector{65536});
        return plan.marched_slabs;
    };
    EXPECT_GE(most(usual_opengl()), 4096);
    EXPECT_LE(most(usual_opengl()), 65535 / 10);
    Capabilities gpu = usual_opengl();
    gpu.software = false;
    EXPECT_GE(most(gpu), 65536);
    Capabilities native = usual_opengl();
    native.cpu = true;
    EXPECT_GE(most(native), 65536);

    nlohmann::json points = nlohmann::json::array();
    for (int i = 0; i < 100; ++i)
        points.push_back({{"value", 1e-6 * i}, {"color", {1, 1, 1}}, {"extinction", i % 2}});
    document["transfer_function"]["points"] = points;
    EXPECT_LE(most(usual_opengl()), 65535 / (4 * 100));
}

TEST(Plan, TracingMakesNoContext) {
    const Plan plan = plan_of(with("/render/method", "trace"), {});
    ASSERT_EQ(plan.omitted.size(), 1u);
    EXPECT_EQ(plan.omitted[0].name, "context");
}

TEST(Plan, EveryOmissionCanBeSwitchedOffByItsName) {
    const Scene scene = read_scene(with("/transfer_function/points/1/opacity", 0), "s");
    const Volume volume = load_volume(scene);
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const auto names = omission_names();
    const Plan plan = make_plan(scene, facts, usual_opengl(), {});
    ASSERT_FALSE(plan.omitted.empty());
    for (const Omission& omission : plan.omitted) {
        EXPECT_NE(std::find(names.begin(), names.end(), omission.name), names.end())
            << omission.name;
        EXPECT_FALSE(omission.reason.empty());
        OmissionSwitch without;
        without.kept = {omission.name};
        for (const Omission& other : make_plan(scene, facts, usual_opengl(), without).omitted) {
            EXPECT_NE(other.name, omission.name);
        }
    }
    OmissionSwitch none;
    none.none = true;
    EXPECT_TRUE(make_plan(scene, facts, usual_opengl(), none).omitted.empty());
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Pictures of the cpu engine do not depend on instruction set, threads or empty space, and frames
// allocate no memory.
#include <tbb/global_control.h>

#include <random>

#include "cpu_fixture.h"
#include "reference/lit_fixtures.h"
#include "simd/instruction_set.h"
#include "support/allocation_count.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

struct FrameCase {
    const char* name;
    Scene scene;
    OmissionSwitch omissions;
};

std::vector<FrameCase> cases(const TransferFunction& colored = smooth_transfer_function(),
                             double seen_from = 0) {
    Scene scene = unit_box_scene(colored, Projection::perspective, 75, 53);
    scene.slice.samples = 100;
    std::vector<FrameCase> all{{"post", scene, {}}, {"blended", scene, leave_nothing_out()}};
    scene.slice.classification = Classification::preintegrated;
    all.push_back({"preintegrated", scene, {}});
    for (const Classification each : {Classification::post, Classification::preintegrated}) {
        Scene lit = scene;
        lit.slice.classification = each;
        lit.lighting = reference_test::directional();
        all.push_back({"lit by colours", lit, {}});
        (*lit.lighting)->lights = {Light{}};
        (*lit.lighting)->power = 7.5;
        all.push_back({"lit by a headlight", lit, leave_nothing_out()});
        lit.target = Target::emulated;
        lit.emulate = {10, AlphaRounding::stochastic, OverRounding::fused, 3};
        all.push_back({"lit codes", lit, {}});
    }
    scene.transfer_function =
        TransferFunction::linear({knot(seen_from, {.3, .6, .9}, 0), knot(1, {.9, .6, .1}, 900)});
    all.push_back({"opaque", scene, {}});  // rays end early
    scene.transfer_function =
        TransferFunction::linear({knot(seen_from, {.3, .6, .9}, 0), knot(1, {.9, .6, .1}, 20)});
    all.push_back({"linear", scene, {}});
    scene.transfer_function = colored;
    for (const Target target : {Target::float16, Target::fixed8, Target::emulated}) {
        scene.target = target;
        scene.emulate = {10, AlphaRounding::stochastic, OverRounding::fused, 3};
        all.push_back({name_of(target), scene, {}});
    }
    scene.slice.classification = Classification::post;
    scene.slice.dither = DitherSettings{.period = 7, .color = true};
    all.push_back({"dithered", scene, {}});
    scene.transfer_function =
        TransferFunction::linear({knot(seen_from, {.3, .6, .9}, 0), knot(1, {.3, .6, .9}, 5)});
    scene.slice.tree = TreeSettings{.factors = {4, 6}, .nodes = NodeArithmetic::fixed};
    all.push_back({"fixed nodes", scene, {}});
    scene.target = Target::fixed8;
    scene.slice.tree = TreeSettings{.factors = {4, 6}};
    all.push_back({"shader nodes", scene, {}});
    return all;
}

TEST(CpuFramesTest, EveryInstructionSetGivesTheSameBits) {
    const Volume volume = gaussians(30);
    const std::vector<std::string> names = instruction_sets();
    for (const FrameCase& each : cases()) {
        const Image best = render_tiles(volume, each.scene, each.omissions);
        for (const std::string& name : names) {
            restrict_instructions(name);
            EXPECT_EQ(render_tiles(volume, each.scene, each.omissions).rgba, best.rgba)
                << each.name << " " << name;
        }
        restrict_instructions(names.front());
    }
}

TEST(CpuFramesTest, ThreadsDoNotChangeThePicture) {
    const Volume volume = gaussians(30);
    for (const FrameCase& each : cases()) {
        const Image many = render_tiles(volume, each.scene, each.omissions);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(render_tiles(volume, each.scene, each.omissions).rgba, many.rgba) << each.name;
    }
}

TEST(CpuFramesTest, FramesAfterTheFirstTakeNoMemory) {
    const Volume volume = gaussians(30);
    for (const FrameCase& each : cases()) {
        const auto renderer = cpu_renderer(volume, each.scene, each.omissions);
        const View view(*each.scene.camera, each.scene.width, each.scene.height);
        renderer->draw(view);
        const std::int64_t before = test::allocation_count();
        renderer->draw(view);
        EXPECT_EQ(test::allocation_count(), before) << each.name;
        EXPECT_GT(renderer->fragments(), 0);
    }
}

// Returns capabilities with which volumes are cut into bricks of at most 25^3 float samples; the
// image needs as much memory as one.
Capabilities small_bricks() {
    Capabilities small = cpu_capabilities();
    small.max_texture_bytes = 16 * 75 * 53;
    return small;
}

TEST(CpuFramesTest, FramesOfSeveralBricksTakeNoMemory) {
    const Volume volume = gaussians(30);
    for (const FrameCase& each : cases()) {
        const auto renderer = cpu_renderer(volume, each.scene, each.omissions, small_bricks());
        renderer->draw(View(*each.scene.camera, 75, 53));
        const View turned_by_70(turned(*each.scene.camera, 70), 75, 53);
        const std::int64_t before = test::allocation_count();
        renderer->draw(turned_by_70);
        EXPECT_EQ(test::allocation_count(), before) << each.name;
    }
}

// A volume of 5^3 blocks of 16^3 cells, of which about one in twenty has scalars above .2.
Volume lumps() {
    std::mt19937 random(5);
    std::array<float, 125> heights{};
    for (float& height : heights) height = random() % 20 == 0 ? 1.f : .19f;
    const auto height_at = [&](double i, double j, double k) {
        const auto brick = [](double at) { return static_cast<std::size_t>(at / 16); };
        const double wave = std::sin(1.3 * i) * std::cos(1.1 * j) * std::sin(.9 * k + .5);
        return heights[(brick(k) * 5 + brick(j)) * 5 + brick(i)] * static_cast<float>(wave * wave);
    };
    return test::volume_of<float>(
        reference_test::make_grid({70, 70, 70}, Centering::cell, glm::dvec3(1. / 70)), height_at);
}

// Slabs are skipped that come near no visible brick: they would add only zeros.
TEST(CpuFramesTest, EmptySpaceIsSkippedBitForBit) {
    const Volume volume = lumps();
    const TransferFunction top = TransferFunction::linear(
        {knot(.2, {.1, .5, .9}, 0), knot(.5, {.9, .5, .1}, 20), knot(1, {1, 1, 1}, 30)});
    OmissionSwitch keep_space;
    keep_space.kept = {"empty_space"};
    for (const FrameCase& each : cases(top, .2)) {
        if (each.omissions.none) continue;
        for (const Capabilities& capabilities : {cpu_capabilities(), small_bricks()}) {
            const auto drawn = [&](const OmissionSwitch& omissions, std::int64_t& samples) {
                const auto renderer = cpu_renderer(volume, each.scene, omissions, capabilities);
                renderer->draw(View(*each.scene.camera, 75, 53));
                samples = renderer->fragments();
                return renderer->read().rgba;
            };
            std::int64_t some = 0, all = 0;
            EXPECT_EQ(drawn({}, some), drawn(keep_space, all)) << each.name;
            EXPECT_LT(some, .8 * static_cast<double>(all)) << each.name;
        }
    }
}

// Views from all sides and from inside, and slabs of many cells.
TEST(CpuFramesTest, EmptySpaceIsSkippedInEveryView) {
    const Volume volume = lumps();
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(.2, {.1, .5, .9}, 0), knot(1, {1, .2, 1}, 30)}),
        Projection::perspective, 41, 43);
    OmissionSwitch keep_space;
    keep_space.kept = {"empty_space"};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-.4, 1.4);
    for (int trial = 0; trial < 8; ++trial) {
        scene.camera->projection =
            trial % 3 == 0 ? Projection::orthographic : Projection::perspective;
        scene.camera->eye = {place(random), place(random), place(random)};
        scene.slice.classification =
            trial % 2 == 0 ? Classification::preintegrated : Classification::post;
        for (const int slabs : {3, 40, 333}) {
            scene.slice.samples = slabs;
            EXPECT_EQ(render_tiles(volume, scene).rgba,
                      render_tiles(volume, scene, keep_space).rgba)
                << trial << " " << slabs;
        }
    }
}

}  // namespace
}  // namespace lamina

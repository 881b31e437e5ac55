// SPDX-License-Identifier: Apache-2.0
// What a picture of the native engine must not depend on, and what a frame must not take.
#include <tbb/global_control.h>

#include "support/allocation_count.h"
#include "tile_fixture.h"
#include "tiles/instruction_set.h"

namespace lamina {
namespace {

struct Case {
    const char* name;
    Scene scene;
    OmissionSwitch omissions;
};

std::vector<Case> cases() {
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective, 75, 53);
    scene.slice.samples = 100;
    std::vector<Case> all{{"post", scene, {}}, {"blended", scene, leave_nothing_out()}};
    scene.slice.classification = Classification::preintegrated;
    all.push_back({"preintegrated", scene, {}});
    for (const Target target : {Target::float16, Target::fixed8, Target::emulated}) {
        scene.target = target;
        scene.emulate = {10, AlphaRounding::stochastic, OverRounding::fused, 3};
        all.push_back({name_of(target), scene, {}});
    }
    scene.slice.classification = Classification::post;
    scene.slice.dither = DitherSettings{.period = 7, .color = true};
    all.push_back({"dithered", scene, {}});
    scene.transfer_function =
        TransferFunction::linear({knot(0, {.3, .6, .9}, 0), knot(1, {.3, .6, .9}, 5)});
    scene.slice.tree = TreeSettings{.factors = {4, 6}, .nodes = NodeArithmetic::fixed};
    all.push_back({"fixed nodes", scene, {}});
    scene.target = Target::fixed8;
    scene.slice.tree = TreeSettings{.factors = {4, 6}};
    all.push_back({"shader nodes", scene, {}});
    return all;
}

TEST(TileFramesTest, EveryInstructionSetGivesTheSameBits) {
    const Volume volume = gaussians(30);
    const std::vector<std::string> names = instruction_sets();
    for (const Case& each : cases()) {
        const Image best = render_tiles(volume, each.scene, each.omissions);
        for (const std::string& name : names) {
            restrict_instructions(name);
            EXPECT_EQ(render_tiles(volume, each.scene, each.omissions).rgba, best.rgba)
                << each.name << " " << name;
        }
        restrict_instructions(names.front());
    }
}

TEST(TileFramesTest, ThreadsDoNotChangeThePicture) {
    const Volume volume = gaussians(30);
    for (const Case& each : cases()) {
        const Image many = render_tiles(volume, each.scene, each.omissions);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(render_tiles(volume, each.scene, each.omissions).rgba, many.rgba) << each.name;
    }
}

TEST(TileFramesTest, FramesAfterTheFirstTakeNoMemory) {
    const Volume volume = gaussians(30);
    for (const Case& each : cases()) {
        const auto renderer = tile_renderer(volume, each.scene, each.omissions);
        const View view(each.scene.camera, each.scene.width, each.scene.height);
        renderer->draw(view);
        const std::int64_t before = test::allocation_count();
        renderer->draw(view);
        EXPECT_EQ(test::allocation_count(), before) << each.name;
        EXPECT_GT(renderer->samples(), 0);
    }
}

}  // namespace
}  // namespace lamina

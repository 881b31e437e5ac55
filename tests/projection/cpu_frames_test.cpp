// SPDX-License-Identifier: Apache-2.0
// Pictures of the cpu engine must not depend on instruction sets or threads, and frames must not
// allocate memory.
#include <tbb/global_control.h>

#include "projection_fixture.h"
#include "simd/instruction_set.h"
#include "support/allocation_count.h"
#include "support/split_box.h"

namespace lamina {
namespace {

struct Case {
    std::string name;
    Scene scene;
};

SceneMesh mesh_of(int cells) {
    return scene_mesh(test::split_box(11, cells, 1e-2, [](const glm::dvec3& p) {
        return .5 + .5 * std::sin(5 * p.x + 3 * p.y) * std::cos(4 * p.z);
    }));
}

std::vector<Case> cases() {
    Scene scene = projection_scene(
        TransferFunction::linear({knot(0, {0, .2, 1}, .2), knot(.3, {0, 1, .3}, 1),
                                  knot(.5, {1, .2, 1}, 9), knot(.7, {.3, 0, 1}, .1),
                                  knot(.7, {1, .6, 0}, 2)}),
        75, 53);
    scene.camera->eye = {1.4, -.5, 1.3};
    scene.camera->center = {.5, .5, .5};
    std::vector<Case> all{{"parts", scene}};
    for (const Target target : {Target::float16, Target::fixed8, Target::emulated}) {
        Scene other = scene;
        other.target = target;
        other.emulate = {10, AlphaRounding::stochastic, OverRounding::fused, 3};
        all.push_back({name_of(target), other});
    }
    for (const ProjectDither dither : {ProjectDither::alpha, ProjectDither::after_blend}) {
        Scene other = scene;
        other.target = Target::fixed8;
        other.project.dither = dither;
        all.push_back({name_of(dither), other});
    }
    for (const Coloring coloring : {Coloring::analytic, Coloring::attenuation, Coloring::vertex}) {
        Scene other = scene;
        other.project.coloring = coloring;
        all.push_back({"coloring " + std::to_string(static_cast<int>(coloring)), other});
    }
    for (const LengthMapping mapping : {LengthMapping::octave, LengthMapping::log2}) {
        Scene other = scene;
        other.project.table = TableSettings{.scalar = 64, .length = 8, .mapping = mapping};
        all.push_back({"table", other});
    }
    Scene one = scene;
    one.transfer_function = TransferFunction::linear({knot(0, {.3, .6, .9}, 2)});
    all.push_back({"constant", one});
    one.target = Target::fixed8;
    one.project.tree = TreeSettings{.factors = {4, 6}, .nodes = NodeArithmetic::fixed};
    all.push_back({"tree", one});
    return all;
}

Image draw(const SceneMesh& mesh, const Scene& scene) {
    return project(mesh, scene, cpu_capabilities());
}

TEST(CpuTetFrames, EveryInstructionSetGivesTheSameBits) {
    const SceneMesh mesh = mesh_of(1500);
    const std::vector<std::string> names = instruction_sets();
    for (const Case& each : cases()) {
        const Image best = draw(mesh, each.scene);
        for (const std::string& name : names) {
            restrict_instructions(name);
            EXPECT_EQ(draw(mesh, each.scene).rgba, best.rgba) << each.name << " " << name;
        }
        restrict_instructions(names.front());
    }
}

TEST(CpuTetFrames, ThreadsDoNotChangeThePicture) {
    const SceneMesh mesh = mesh_of(3000);
    for (const Case& each : cases()) {
        const Image many = draw(mesh, each.scene);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(draw(mesh, each.scene).rgba, many.rgba) << each.name;
    }
}

TEST(CpuTetFrames, FramesAfterTheFirstTakeNoMemory) {
    const SceneMesh mesh = mesh_of(1500);
    for (const Case& each : cases()) {
        const auto renderer = make_renderer(mesh, each.scene, cpu_capabilities());
        const View view(*each.scene.camera, each.scene.width, each.scene.height);
        renderer->draw(view);
        const std::int64_t before = test::allocation_count();
        renderer->draw(view);
        EXPECT_EQ(test::allocation_count(), before) << each.name;
        EXPECT_GT(renderer->tets_drawn(), 0) << each.name;
    }
}

}  // namespace
}  // namespace lamina

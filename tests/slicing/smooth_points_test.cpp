// SPDX-License-Identifier: Apache-2.0
// Exact segments that follow curves in place of many straight pieces, in cells that cross many of
// these.
#include <gtest/gtest.h>

#include <cmath>

#include "cpu_fixture.h"
#include "exact_fixture.h"
#include "optics/pieces.h"
#include "simd/instruction_set.h"

namespace lamina {
namespace {

const Volume& cells() {
    static const Volume volume = noise<float>({13, 9, 11}, Centering::cell, 1);
    return volume;
}

// Returns smooth transfer functions of one colour and of several. `unit`: the unit length; a
// smaller one makes cells deeper.
std::vector<TransferFunction> curves(double unit) {
    std::vector<TransferKnot> sampled;
    for (int i = 0; i <= 200; ++i) {
        const double value = i / 200.0, wave = std::sin(7 * value);
        sampled.push_back({value, {{1, .5, .25}, (1.1 + wave) / unit}, true});
    }
    return {TransferFunction::linear_opacity({{.1, {1, 1, 1}, 0}, {.9, {1, 1, 1}, .9}}, unit),
            TransferFunction::linear_opacity({{0, {.1, .2, 1}, 0}, {1.1, {1, .9, 0}, 1}}, unit),
            TransferFunction::linear_opacity(
                {{0, {1, 0, 0}, .7}, {.5, {0, 1, 0}, 0}, {.5, {0, 1, 0}, .4}, {1, {0, 0, 1}, .95}},
                unit),
            TransferFunction::linear(sampled)};
}

Scene scene_of(const TransferFunction& function) {
    Scene scene = exact_scene(function, Projection::perspective);
    look_from(cells(), {.4, -.7, .9}, 1.2, scene);
    return scene;
}

double claimed_error(const Scene& scene) {
    const Facts facts = measure(scene, cells(), measure_bricks(cells()));
    return make_plan(scene, facts, cpu_capabilities(), {}).slice.found_error();
}

TEST(SmoothPoints, KeepTheErrorTheyClaim) {
    for (const double unit : {.2, 2.0, 30.0}) {
        for (const TransferFunction& function : curves(unit)) {
            Scene scene = scene_of(function);
            const Image truth = trace(cells(), scene, 1e-8);
            const double claimed = claimed_error(scene);
            EXPECT_DOUBLE_EQ(claimed, promised + largest_curve_error);
            const Image picture = render_tiles(cells(), scene);
            EXPECT_LE(linf(picture, truth), claimed) << unit;
            const Image straight = render_tiles(cells(), scene, keep("smooth_points"));
            EXPECT_LE(linf(straight, truth), promised) << unit;
            EXPECT_GT(linf(straight, picture), 0) << unit;
            scene.max_error = .5;  // too small for curves
            EXPECT_EQ(linf(render_tiles(cells(), scene), straight), 0) << unit;
        }
    }
}

TEST(SmoothPoints, KeepTheErrorTheyClaimIfLit) {
    for (const TransferFunction& function : curves(2)) {
        Scene scene = scene_of(function);
        scene.lighting = Lighting{};
        (*scene.lighting)->smallest_gradient = .1;
        const double claimed = claimed_error(scene);
        EXPECT_LE(linf(render_tiles(cells(), scene), trace(cells(), scene, 1e-6)), claimed);
    }
}

TEST(SmoothPoints, AllInstructionSetsDrawTheSame) {
    const std::vector<std::string> names = instruction_sets();
    for (const TransferFunction& function : curves(1)) {
        const Scene scene = scene_of(function);
        const Image picture = render_tiles(cells(), scene);
        for (const std::string& name : names) {
            restrict_instructions(name);
            EXPECT_EQ(render_tiles(cells(), scene).rgba, picture.rgba) << name;
        }
        restrict_instructions(names.front());
    }
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Exact segments under strong lights, and in volumes so small that one kink of the light is a large
// part of the picture.
#include <gtest/gtest.h>

#include <random>

#include "engine_fixture.h"
#include "reference/lit_fixtures.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using LitKinks = EngineTest;
INSTANTIATE_TEST_SUITE_P(Engines, LitKinks, every_engine, engine_name);

// Returns a lit scene. `depth`: about the optical depth along the volume's diagonal.
Scene scene_of(const Volume& volume, double depth) {
    const ValueRange range = measure_bricks(volume).whole;
    const double diagonal = reference_test::diagonal_of(volume.grid());
    const double extinction = depth / diagonal;
    const auto at = [&](double share) { return range.lo + share * (range.hi - range.lo); };
    Scene scene = unit_box_scene(
        TransferFunction::linear(
            {knot(at(.1), {.9, .2, .1}, 0), knot(at(.4), {.3, .9, .2}, .4 * extinction),
             knot(at(.6), {1, .8, .7}, 3 * extinction), knot(at(1), {.1, .3, 1}, extinction)}),
        Projection::perspective, 48, 36);
    scene.slice.classification = Classification::exact;
    scene.lighting = Lighting{};
    (*scene.lighting)->smallest_gradient = .01 * (range.hi - range.lo);
    scene.camera->center = reference_test::middle_of(volume.grid());
    scene.camera->eye =
        scene.camera->center + .8 * diagonal * glm::normalize(glm::dvec3(.4, -.7, .9));
    return scene;
}

Volume noise(const std::array<std::int64_t, 3>& size, int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> unit(0, 1);
    return test::volume_of<float>(test::grid_of(size, Centering::cell),
                                  [&](double, double, double) { return unit(random); });
}

TEST_P(LitKinks, StrongLightsKeepMaxError) {
    const Volume volume = noise({13, 9, 11}, 1);
    for (const double strength : {1., 10.}) {
        Scene scene = scene_of(volume, 5);
        (*scene.lighting)->lights[0].color = glm::dvec3(strength);
        const Image traced = trace(volume, scene, 1e-6);
        // llvmpipe limits loops to fewer iterations than an error of 1 would take under strong
        // lights (plan/choices.h).
        for (const double max_error : {1., 4.}) {
            if (!is_native() && max_error < strength) continue;
            scene.max_error = max_error;
            EXPECT_LE(linf(draw(volume, scene), traced), max_error) << strength;
        }
    }
}

TEST_P(LitKinks, TinyVolumesKeepMaxError) {
    for (int seed = 0; seed < (is_native() ? 40 : 4); ++seed) {
        const Volume volume = noise({2, 2, 2}, seed);
        Scene scene = scene_of(volume, 20);
        (*scene.lighting)->specular = .5;
        (*scene.lighting)->power = seed % 3 == 0 ? 64 : 10;
        const Image traced = trace(volume, scene, 1e-6);
        for (const double max_error : {.25, 1.}) {
            if (!is_native() && max_error < 1) continue;
            scene.max_error = max_error;
            EXPECT_LE(linf(draw(volume, scene), traced), max_error) << seed;
        }
    }
}

}  // namespace
}  // namespace lamina

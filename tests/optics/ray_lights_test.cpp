// SPDX-License-Identifier: Apache-2.0
#include "optics/ray_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

namespace lamina {
namespace {

Lighting two_lights() {
    Lighting lighting;
    lighting.ambient = .25;
    lighting.diffuse = .5;
    lighting.specular = .75;
    lighting.power = 3;
    lighting.smallest_gradient = 2;
    lighting.lights = {{glm::dvec3(0, 3, 4), {1, .5, 0}}, {std::nullopt, {.25, .5, 2}}};
    return lighting;
}

// The formula of docs/numerics.md, section 10, with the eye along z and the gradient (3, 0, 4): q =
// (.6, 0, .8), w = 25 / 29. First light: q.l = .64; l + v = (0, .6, 1.8), q.h = 1.44 / sqrt(3.6).
// Headlight: q.l = q.h = .8.
TEST(RayLights, FollowTheFormula) {
    const RayLights lights(two_lights(), {0, 0, 7});
    const RayLights::Effect effect = lights.effect({3, 0, 4});
    EXPECT_NEAR(effect.weight, 25. / 29, 1e-15);
    const double shine = std::pow(1.44 / std::sqrt(3.6), 3), head = std::pow(.8, 3);
    const glm::dvec3 change =
        glm::dvec3(.25 - 1) + .5 * (.64 * glm::dvec3(1, .5, 0) + .8 * glm::dvec3(.25, .5, 2));
    const glm::dvec3 highlight =
        .75 * (shine * glm::dvec3(1, .5, 0) + head * glm::dvec3(.25, .5, 2));
    const glm::dvec3 color(.1, .2, .3), on = effect.on(color);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(effect.change[c], change[c], 1e-15);
        EXPECT_NEAR(effect.highlight[c], highlight[c], 1e-15);
        EXPECT_NEAR(on[c], 25. / 29 * (color[c] * change[c] + highlight[c]), 1e-15);
    }
    // Both sides are lit.
    EXPECT_EQ(lights.effect({-3, 0, -4}).on(color), on);
}

TEST(RayLights, ALightBehindHasNoHighlight) {
    Lighting lighting = two_lights();
    lighting.lights = {{glm::dvec3(-.1, -.2, -.3), glm::dvec3(1)}};
    const RayLights lights(lighting, {1, 2, 3});
    EXPECT_EQ(lights.effect({1, 5, 2}).highlight, glm::dvec3(0));
    EXPECT_GT(lights.effect({1, 5, 2}).change.x, lighting.ambient - 1);
}

// Results are finite over the full range of gradients and of smallest gradients: no overflow and no
// 0 / 0.
TEST(RayLights, AreFiniteForExtremeGradients) {
    Lighting lighting = two_lights();
    for (const double smallest : {1e-150, 1e-30, 1., 1e150}) {
        lighting.smallest_gradient = smallest;
        const RayLights lights(lighting, {1e-90, 2e-90, -1e-90});
        EXPECT_EQ(lights.effect(glm::dvec3(0)).on({1, 1, 1}), glm::dvec3(0));
        for (const double size : {5e-324, 1e-160, 1e-20, 1., 1e140, 1e300}) {
            const RayLights::Effect effect = lights.effect(size * glm::dvec3(1, -1, .5));
            const double ratio = size / smallest;
            if (ratio > 1e10) {
                EXPECT_EQ(effect.weight, 1);
            } else if (ratio < 1e-10) {
                EXPECT_LT(effect.weight, 1e-19);
            }
            for (int c = 0; c < 3; ++c) {
                EXPECT_TRUE(effect.change[c] >= -1 && effect.change[c] <= 1.5) << size;
                EXPECT_TRUE(effect.highlight[c] >= 0 && effect.highlight[c] <= 1.7) << size;
            }
        }
    }
}

TEST(RayLights, StayWithinTheirStatedBounds) {
    const RayLights lights(two_lights(), {0, 0, 1});
    const double brightest = .8;
    for (int i = 0; i < 1000; ++i) {
        const double a = .7 * i, b = .13 * i;
        const glm::dvec3 gradient =
            .02 * i * glm::dvec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
        const RayLights::Effect effect = lights.effect(gradient);
        EXPECT_NEAR(effect.weight, lights.weight(.02 * i), 1e-15);
        const glm::dvec3 on = effect.on(glm::dvec3(brightest));
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(std::abs(on[c]),
                      effect.weight * lights.largest_effect(brightest) * (1 + 1e-15));
            EXPECT_LE(brightest + on[c], lights.brightest_lit(brightest) * (1 + 1e-15));
            EXPECT_GE(brightest + on[c], 0);
        }
    }
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Lightings for the tests of the reference tracers.
#pragma once

#include <vector>

#include "fixtures.h"
#include "lamina/settings.h"

namespace lamina::reference_test {

inline Lighting random_lighting(Random& random) {
    Lighting lighting;
    lighting.ambient = random.uniform();
    lighting.diffuse = random.uniform(0, 1.5);
    lighting.specular = random.below(3) == 0 ? 0 : random.uniform();
    constexpr double powers[] = {1, 2.5, 10, 64, 400};
    constexpr double smallest[] = {1e-4, .01, .1, 1};
    lighting.power = powers[random.below(5)];
    lighting.smallest_gradient = smallest[random.below(4)];
    lighting.lights.clear();
    for (int i = random.below(3); i >= 0; --i) {
        Light& light = lighting.lights.emplace_back();
        if (random.below(3) > 0) light.direction = random.point(-1, 1);
        light.color = random.point();
    }
    return lighting;
}

// Returns lighting that changes nothing: ambient light alone, of full strength.
inline Lighting ambient_alone() {
    Lighting lighting;
    lighting.ambient = 1;
    lighting.diffuse = lighting.specular = 0;
    lighting.smallest_gradient = .01;
    return lighting;
}

// Returns two lights with fixed directions.
inline Lighting directional() {
    Lighting lighting;
    lighting.ambient = .25;
    lighting.diffuse = .875;
    lighting.specular = .5;
    lighting.power = 5;
    lighting.smallest_gradient = .5;
    lighting.lights = {{glm::dvec3(1, 2, -.5), {1, .5, .25}}, {glm::dvec3(-3, .1, 1), {0, .5, 1}}};
    return lighting;
}

// Returns lightings with wide and narrow highlights, with whole and odd powers, with and without
// headlights.
inline std::vector<Lighting> lightings() {
    Lighting shiny = directional();
    shiny.power = 64;
    Lighting odd;
    odd.power = 7.5;
    odd.lights.push_back({glm::dvec3(1, .2, .3), {.2, .4, .6}});
    Lighting matt;
    matt.specular = 0;
    return {Lighting{}, shiny, odd, matt};
}

// Returns the lit colour of a pixel with these unlit colour and opacity, if the gradient is the
// same on the whole ray, seen in direction `forward`: the formula of docs/numerics.md, section 10,
// with one q and w.
inline glm::dvec3 lit_by_one_gradient(const glm::dvec3& unlit, double alpha,
                                      const glm::dvec3& gradient, const Lighting& lighting,
                                      const glm::dvec3& forward) {
    const double square = glm::dot(gradient, gradient), eps = *lighting.smallest_gradient;
    const double w = square / (square + eps * eps);
    const glm::dvec3 q = glm::normalize(gradient), v = -glm::normalize(forward);
    glm::dvec3 diffuse(0), highlight(0);
    for (const Light& light : lighting.lights) {
        const glm::dvec3 l = light.direction ? glm::normalize(*light.direction) : v;
        const double shine = std::abs(glm::dot(q, glm::normalize(l + v)));
        diffuse += light.color * std::abs(glm::dot(q, l));
        highlight += light.color * std::pow(shine, lighting.power);
    }
    return unlit * (1 - w + w * (lighting.ambient + lighting.diffuse * diffuse)) +
           alpha * w * lighting.specular * highlight;
}

}  // namespace lamina::reference_test

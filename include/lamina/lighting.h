// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

#include "lamina/auto.h"

namespace lamina {

struct Light {
    // Towards the light, in world space; of any length, but not 0. None: a headlight, towards the
    // eye along every ray.
    std::optional<glm::dvec3> direction;
    glm::dvec3 color{1};  // of the scene's colour space, 0..1000

    friend bool operator==(const Light&, const Light&) = default;
};

// Emission is lit by the gradient of the scalar, on both of its sides (docs/numerics.md, section
// 10); extinction is not. What is hardly steeper than `smallest_gradient`, or less steep, fades
// into the unlit picture.
struct Lighting {
    static constexpr int most_lights = 8;
    static constexpr double largest_term = 1000, largest_power = 1000;
    static constexpr double least_gradient = 1e-150, largest_gradient = 1e150;

    double ambient = .1, diffuse = .7, specular = .2;  // 0..1000
    double power = 10;                                 // of the specular highlight, 1..1000
    // In scalar units per world unit, 1e-150..1e150; automatic: chosen from the data.
    Auto<double> smallest_gradient;
    std::vector<Light> lights = std::vector<Light>(1);  // 1..8; a headlight

    friend bool operator==(const Lighting&, const Lighting&) = default;
};

}  // namespace lamina

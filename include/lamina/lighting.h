// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

#include "lamina/auto.h"

namespace lamina {

struct Light {
    // Direction towards the light, in world space, of any length but 0. Without one the light is a
    // headlight: along every ray it stands at the eye.
    std::optional<glm::dvec3> direction;
    glm::dvec3 color{1};  // in the scene's colour space, 0..1000

    friend bool operator==(const Light&, const Light&) = default;
};

// Lights the emission by the gradient of the scalar, on both of its sides (docs/numerics.md,
// section 10); extinction stays as it is. If the gradient is hardly longer than
// `smallest_gradient`, or shorter, the light fades into the unlit picture.
struct Lighting {
    static constexpr int most_lights = 8;
    static constexpr double largest_term = 1000, largest_power = 1000;
    static constexpr double least_gradient = 1e-150, largest_gradient = 1e150;

    double ambient = .1, diffuse = .7, specular = .2;  // 0..1000
    double power = 10;                                 // exponent of the highlight, 1..1000
    // Length in scalar units per world unit, 1e-150..1e150; chosen from the data if automatic.
    Auto<double> smallest_gradient;
    std::vector<Light> lights = std::vector<Light>(1);  // 1..8; a headlight

    friend bool operator==(const Lighting&, const Lighting&) = default;
};

}  // namespace lamina

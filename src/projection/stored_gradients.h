// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

#include "lamina/lighting.h"

namespace lamina {

inline const std::array world_axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};

// The gradients at the points of a mesh, in a unit in which float32 has room for them.
struct StoredGradients {
    StoredGradients() = default;  // nothing is lit
    // `gradients`: in scalar units per world unit. `smallest`: the light's smallest gradient.
    StoredGradients(std::span<const glm::dvec3> gradients, double smallest);

    // Gradients times `scale`, which depends on the smallest gradient alone: usual ones are then
    // far below 1. Those around a value that marks missing data may be longer: tets shorten them
    // (scale_of_tet()).
    std::vector<glm::vec3> at_points;
    double scale = 1;  // a power of two

    // Largest component of a tet's gradients after scaling: lengths are then below 1.
    static constexpr double most_of_tet = 0.5;
    // Returns the factor for all gradients of a tet, of which `largest` is the largest component.
    // Light depends on directions, which stay. Lengths matter only near the smallest gradient: in a
    // tet that is scaled, with gradients of 2^38 of it and more, that is less than 1e-11 of the
    // tet.
    static double scale_of_tet(double largest) {
        return largest > most_of_tet ? most_of_tet / largest : 1;
    }

    // Returns the square of a smallest gradient in this unit. It is limited to the numbers that
    // float32 can square: outside, all or nothing is lit.
    float smallest_square(const Lighting& lighting) const;
};

}  // namespace lamina

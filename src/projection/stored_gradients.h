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

    // Times `scale`; the longest has a length of at most 1. Those around a value that marks missing
    // data may be 1e30 times as long as others: they are shortened, so that the others are numbers.
    std::vector<glm::vec3> at_points;
    double scale = 1;  // a power of two

    // The square of a smallest gradient in this unit. It is kept to what float32 can square:
    // outside, all or nothing is lit.
    float smallest_square(const Lighting& lighting) const;
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace lamina {

inline const std::array world_axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};

// The gradients at the points of a mesh, in a unit in which float32 has room for them.
struct StoredGradients {
    StoredGradients() = default;  // nothing is lit
    // `gradients`: in scalar units per world unit.
    explicit StoredGradients(std::span<const glm::dvec3> gradients);

    std::vector<glm::vec3> at_points;  // times `scale`; the longest has a length of at most 1
    double scale = 1;                  // a power of two
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace lamina {

// Keeps the side to which the normal points: dot(normal, p - point) >= 0. Coordinates are in world
// units; the normal has any length above 0.
struct ClipPlane {
    glm::dvec3 point{0}, normal{0, 0, 1};

    friend bool operator==(const ClipPlane&, const ClipPlane&) = default;
};

// Keeps what lies between two corners, in world units. Nothing is kept unless min <= max on each
// axis.
struct ClipBox {
    glm::dvec3 min{0}, max{0};

    friend bool operator==(const ClipBox&, const ClipBox&) = default;
};

// A clip keeps the part of the data that lies on the kept side of all planes and in the box.
struct Clip {
    static constexpr std::size_t most_planes = 32;

    std::vector<ClipPlane> planes;  // at most most_planes in scene files
    std::optional<ClipBox> box;

    bool keeps_all() const { return planes.empty() && !box; }

    friend bool operator==(const Clip&, const Clip&) = default;
};

}  // namespace lamina

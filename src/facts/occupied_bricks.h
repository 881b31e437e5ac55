// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include "volume/min_max_bricks.h"

namespace lamina {

// Which bricks of MinMaxBricks the transfer function shows something in, and how far it is to them.
struct OccupiedBricks {
    static constexpr int farthest = 255;

    std::array<std::int64_t, 3> count{0, 0, 0};
    // From each brick to the nearest that shows something, in bricks along the axis on which they
    // are farthest apart: 0 for those that do. At most `farthest`, also where there are none. x
    // fastest.
    std::vector<std::uint8_t> distance;

    // Replaces distances of 0 and `farthest`, shown and not, by the true ones.
    void measure_distances();

    std::size_t place(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * count[1] + y) * count[0] + x);
    }
    // Of the brick that holds a point of index space, or is nearest to it.
    std::size_t place_of(const glm::dvec3& point) const;

    std::uint8_t distance_at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return distance[place(x, y, z)];
    }

    // Whether one that shows something touches the part of the volume between two points of index
    // space. Its outermost bricks also hold what lies beyond them.
    bool any_in(const glm::dvec3& min, const glm::dvec3& max) const;

    // A part of index space with a point's brick in its middle: the largest known that shows
    // nothing, or, where that brick does show something (false), it alone. Endless beyond the
    // volume.
    bool empty_around(const glm::dvec3& point, glm::dvec3& min, glm::dvec3& max) const;
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

#include "base/sparse_bytes.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Which bricks of MinMaxBricks show something under the transfer function, and how far each brick
// is from them.
struct OccupiedBricks {
    // Bricks farther away take no memory (base/sparse_bytes.h): large volumes are mostly empty.
    static constexpr int farthest = 63;

    std::array<std::int64_t, 3> count{0, 0, 0};
    // From each brick the distance to the nearest one that shows something: 0 for those that do. It
    // is counted in bricks along the axis on which the two are farthest apart, and is at most
    // `farthest`, also where no brick shows anything. x fastest.
    SparseBytes distance;

    // Computes the distances from an input of 0 (shows something) and `farthest` (shows nothing).
    void measure_distances();

    std::size_t place(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * count[1] + y) * count[0] + x);
    }
    // The place of the brick that holds a point of index space, or that is nearest to it.
    std::size_t place_of(const glm::dvec3& point) const;

    std::uint8_t distance_at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return distance[place(x, y, z)];
    }

    // Whether a brick that shows something is among those from `first` to `last`. The distances
    // must have been measured, as for all below.
    bool any_of(const std::array<std::int64_t, 3>& first,
                const std::array<std::int64_t, 3>& last) const;
    // Whether a brick that shows something touches the box between two points of index space. The
    // outermost bricks also stand for what lies beyond the volume.
    bool any_in(const glm::dvec3& min, const glm::dvec3& max) const;

    // Finds a box of index space around a point's brick. True: the box is the largest known that
    // shows nothing. False: that brick shows something, and the box is the brick alone. Boxes that
    // reach the volume's border are endless beyond it.
    bool empty_around(const glm::dvec3& point, glm::dvec3& min, glm::dvec3& max) const;
};

}  // namespace lamina

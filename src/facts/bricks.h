// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "base/memory.h"
#include "lamina/transfer_function.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The bricks that the transfer function makes visible, and the distance of each brick to them.
struct OccupiedBricks {
    // Distance from which on bricks take no memory: large volumes are mostly empty.
    static constexpr int farthest = 63;

    std::array<std::int64_t, 3> count{0, 0, 0};
    // Distance to the nearest visible brick, 0 for visible ones, in bricks along the axis on which
    // the two are farthest apart, at most `farthest`, also if none is visible. x fastest.
    SparseBytes distance;

    // Computes the distances from an input of 0 (visible) and `farthest` (invisible).
    void measure_distances();

    std::size_t place(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * count[1] + y) * count[0] + x);
    }
    // Returns the place of the brick that holds a point of index space, or of the nearest one.
    std::size_t place_of(const glm::dvec3& point) const;

    std::uint8_t distance_at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return distance[place(x, y, z)];
    }

    // Tells whether a brick from `first` to `last` is visible. Needs distances, as all below.
    bool any_of(const std::array<std::int64_t, 3>& first,
                const std::array<std::int64_t, 3>& last) const;
    // Tells whether a visible brick, the outermost endless, touches a box of index space.
    bool any_in(const glm::dvec3& min, const glm::dvec3& max) const;

    // Finds a box of index space around a point's brick: returns true if nothing in it is visible;
    // false if the brick is, and the box is the brick. Boxes at the border are endless beyond it.
    bool empty_around(const glm::dvec3& point, glm::dvec3& min, glm::dvec3& max) const;
};

// The bricks over which the transfer function has one colour and extinction; empty if they are less
// than `least_share` of the visible ones. Those that touch share samples, so have the same optics.
struct ConstantBricks {
    static constexpr double least_share = 0.05;
    // Number of kinds that are kept, the most frequent ones; other bricks count as varied.
    static constexpr std::size_t most_kinds = 16;

    double share = 0;  // share of the bricks that show something
    std::vector<OpticalProperties> kinds;
    SparseBytes kind;       // for each constant brick an index into kinds; x fastest
    OccupiedBricks varied;  // distance to the nearest brick that is not constant

    std::uint8_t kind_at(const glm::dvec3& point) const { return kind[varied.place_of(point)]; }
};

// `occupied`: of the same bricks and transfer function. `margin`: the largest error of a scalar.
ConstantBricks find_constant_bricks(const TransferFunction& transfer_function,
                                    const MinMaxBricks& bricks, const OccupiedBricks& occupied,
                                    double margin);

}  // namespace lamina

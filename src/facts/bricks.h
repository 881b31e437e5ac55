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

// The visible bricks (4 x 4 x 4 cells), and the distance of each brick to the nearest of them.
struct OccupiedBricks {
    // Largest stored distance. Pages of `distance` with nothing else take no memory.
    static constexpr int farthest = 63;

    std::array<std::int64_t, 3> count{0, 0, 0};
    // Chebyshev distance of each brick to the nearest visible brick, in bricks: 0 if it is visible
    // itself, `farthest` at most and if no brick is visible. x fastest.
    SparseBytes distance;

    // Computes `distance` in place from 0 for visible and `farthest` for invisible bricks.
    void measure_distances();

    std::size_t place(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * count[1] + y) * count[0] + x);
    }
    // Returns the place of the brick that holds a point of index space, or of the nearest one.
    std::size_t place_of(const glm::dvec3& point) const;

    std::uint8_t distance_at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return distance[place(x, y, z)];
    }

    // Tells whether some brick in the box of bricks first .. last, both included, is visible. This
    // function and those below need the distances (measure_distances()).
    bool any_of(const std::array<std::int64_t, 3>& first,
                const std::array<std::int64_t, 3>& last) const;
    // Tells whether an index-space box meets a visible brick; outermost bricks are endless.
    bool any_in(const glm::dvec3& min, const glm::dvec3& max) const;

    // Sets `min` and `max` to a box of index space around the brick that holds a point. Returns
    // true if nothing in the box is visible; returns false if the brick is visible, and then the
    // box is the brick. Boxes that reach the volume's border are endless beyond it.
    bool empty_around(const glm::dvec3& point, glm::dvec3& min, glm::dvec3& max) const;
};

// The visible bricks with one colour and one extinction; empty if they are less than `least_share`
// of the visible ones. Constant bricks that touch have equal optics, because they share samples.
struct ConstantBricks {
    static constexpr double least_share = 0.05;
    // Largest number of kinds (colour and extinction); bricks of rarer kinds count as varied.
    static constexpr std::size_t most_kinds = 16;

    double share = 0;  // constant bricks as a share of the visible ones
    std::vector<OpticalProperties> kinds;
    SparseBytes kind;       // for each constant brick an index into kinds; x fastest
    OccupiedBricks varied;  // distance to the nearest brick that is not constant

    std::uint8_t kind_at(const glm::dvec3& point) const { return kind[varied.place_of(point)]; }
};

// Finds the constant bricks. `occupied` must belong to the same bricks and transfer function.
// `margin`: the largest error of an interpolated scalar, in the data's units.
ConstantBricks find_constant_bricks(const TransferFunction& transfer_function,
                                    const MinMaxBricks& bricks, const OccupiedBricks& occupied,
                                    double margin);

}  // namespace lamina

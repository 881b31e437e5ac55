// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "facts/occupied_bricks.h"
#include "lamina/transfer_function.h"

namespace lamina {

// The bricks over which the transfer function has one colour and one extinction; empty if they are
// less than `least_share` of the visible bricks. Neighbouring bricks share their border samples, so
// constant bricks that touch have the same optical properties.
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

// `occupied` must come from the same bricks and transfer function. `margin`: the largest error of a
// scalar.
ConstantBricks find_constant_bricks(const TransferFunction& transfer_function,
                                    const MinMaxBricks& bricks, const OccupiedBricks& occupied,
                                    double margin);

}  // namespace lamina

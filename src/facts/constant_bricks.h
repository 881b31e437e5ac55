// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "facts/occupied_bricks.h"
#include "lamina/transfer_function.h"

namespace lamina {

// The bricks over which the transfer function has one colour and one extinction, where these are at
// least `least_share` of those that show something; else none. Neighbours share their border
// samples, so constant bricks that touch are of one kind.
struct ConstantBricks {
    static constexpr double least_share = 0.05;
    static constexpr std::size_t most_kinds = 16;  // the commonest; others count as varied

    double share = 0;  // of the bricks that show something
    std::vector<OpticalProperties> kinds;
    std::vector<std::uint8_t> kind;  // of each constant brick, into kinds; x fastest
    OccupiedBricks varied;           // how far it is to the nearest brick that is not constant

    std::uint8_t kind_at(const glm::dvec3& point) const { return kind[varied.place_of(point)]; }
};

// `occupied`: of the same bricks and transfer function. `margin`: scalars may be wrong by so much.
ConstantBricks find_constant_bricks(const TransferFunction& transfer_function,
                                    const MinMaxBricks& bricks, const OccupiedBricks& occupied,
                                    double margin);

}  // namespace lamina

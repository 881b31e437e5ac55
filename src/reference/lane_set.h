// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace lamina {

// Some lanes of a packet of rays: a bit each, up to longest_vector.
using LaneSet = std::uint32_t;

constexpr LaneSet lane_bit(std::size_t lane) {
    return LaneSet{1} << lane;
}

template <typename Visit>
void for_each_lane(LaneSet lanes, const Visit& visit) {
    for (LaneSet left = lanes; left != 0; left &= left - 1)
        visit(static_cast<std::size_t>(std::countr_zero(left)));
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace lamina {

// A set of lanes of a vector or of a packet of rays: a bit each, the first lane lowest.
using LaneSet = std::uint32_t;

// Largest number of doubles in a vector (8: AVX-512), so that a set of their lanes fits a byte.
inline constexpr std::size_t longest_vector = 8;

constexpr LaneSet lane_bit(std::size_t lane) {
    return LaneSet{1} << lane;
}

// A number for each lane of a packet of rays.
struct alignas(64) LaneRow : std::array<double, longest_vector> {};

template <typename Visit>
void for_each_lane(LaneSet lanes, const Visit& visit) {
    for (LaneSet left = lanes; left != 0; left &= left - 1)
        visit(static_cast<std::size_t>(std::countr_zero(left)));
}

// For each set of eight lanes: the numbers of its members in order, one in each byte, the first in
// the lowest. (Highway 1.0.3 copies its own table of this kind to the stack at every Compress() of
// doubles, or of eight floats.)
inline constexpr std::array<std::uint64_t, 256> members_of = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned set = 0; set < 256; ++set) {
        unsigned count = 0;
        for (unsigned lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1) != 0) table[set] |= std::uint64_t{lane} << (8 * count++);
    }
    return table;
}();

// For each set of eight lanes: how many members come before each lane, one number in each byte.
inline constexpr std::array<std::uint64_t, 256> members_before = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned set = 0; set < 256; ++set) {
        for (unsigned lane = 0; lane < 8; ++lane) {
            const auto before = static_cast<unsigned>(std::popcount(set & ((1u << lane) - 1)));
            table[set] |= std::uint64_t{before} << (8 * lane);
        }
    }
    return table;
}();

}  // namespace lamina

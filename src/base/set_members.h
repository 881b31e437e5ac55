// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// For each set of eight lanes its members, a byte each, the first lowest. (Highway 1.0.3 copies
// its own such tables to the stack at every Compress() of vectors of doubles, or of eight floats.)
inline constexpr std::array<std::uint64_t, 256> members_of = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned set = 0; set < 256; ++set) {
        unsigned count = 0;
        for (unsigned lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1) != 0) table[set] |= std::uint64_t{lane} << (8 * count++);
    }
    return table;
}();

}  // namespace lamina

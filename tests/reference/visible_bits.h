// SPDX-License-Identifier: Apache-2.0
// Reads single bits of VisibleCells.
#pragma once

#include <cstdint>

#include "reference/cells.h"

namespace lamina::reference_test {

inline bool bit_at(const std::uint64_t* words, std::int64_t place) {
    return (words[place / 64] >> place % 64 & 1) != 0;
}

inline CellIndex block_of(const CellIndex& cell) {
    constexpr std::int64_t edge = VisibleCells::edge;
    return {(cell[0] + 1) / edge, (cell[1] + 1) / edge, (cell[2] + 1) / edge};
}

inline bool block_shows(const VisibleCells& visible, const CellIndex& block) {
    const std::int64_t line = block[2] * visible.count()[1] + block[1];
    return bit_at(visible.blocks(), line * visible.line_bits() + block[0]);
}

inline bool cell_shows(const VisibleCells& visible, const CellIndex& cell) {
    constexpr std::int64_t edge = VisibleCells::edge;
    const CellIndex block = block_of(cell);
    const std::int64_t line = block[2] * visible.count()[1] + block[1];
    std::int64_t place = line * visible.count()[0] + block[0];
    for (const std::size_t axis : {2, 1, 0}) place = place * edge + (cell[axis] + 1) % edge;
    return bit_at(visible.cells(), place);
}

}  // namespace lamina::reference_test

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "lamina/volume.h"
#include "reference/cell_walk.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Which cells of a volume in memory may show something, and which blocks of edge^3 cells have one
// that may. The tracer judges pictures that are drawn by MinMaxBricks, and so does not use these
// itself.
class VisibleCells {
  public:
    static constexpr std::int64_t edge = 8;

    // Without a volume, every cell may show something.
    VisibleCells() = default;
    VisibleCells(const Volume& volume, const TransferIntervals& transfer);  // parallel
    static std::uint64_t bytes_for(const Grid& grid);

    // Whether a cell (CellWalk) lies in a block that shows nothing, and the block's first and last
    // cells. The outermost blocks hold the half voxels outside the samples, too.
    bool hidden(const CellIndex& cell, CellIndex& first, CellIndex& last) const {
        if (any_.empty()) return false;
        std::array<std::int64_t, 3> block;
        for (std::size_t axis = 0; axis < 3; ++axis)
            block[axis] = std::clamp<std::int64_t>(cell[axis], 0, edge * count_[axis] - 1) / edge;
        if (any_[place_of(block)] != 0) return false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = block[axis] == 0 ? -1 : block[axis] * edge;
            last[axis] = block[axis] * edge + edge - 1;
        }
        return true;
    }

    // Whether a cell of a block that is not hidden may show something.
    bool may_show(const CellIndex& cell) const {
        if (any_.empty() || std::min({cell[0], cell[1], cell[2]}) < 0) return true;
        const std::size_t row =
            place_of({cell[0] / edge, cell[1] / edge, cell[2] / edge}) * rows_of_block +
            static_cast<std::size_t>(cell[2] % edge * edge + cell[1] % edge);
        return (rows_[row] >> (cell[0] % edge) & 1) != 0;
    }

  private:
    static constexpr std::size_t rows_of_block = edge * edge;
    static std::array<std::int64_t, 3> blocks_of(const Grid& grid);

    std::size_t place_of(const std::array<std::int64_t, 3>& block) const {
        return static_cast<std::size_t>((block[2] * count_[1] + block[1]) * count_[0] + block[0]);
    }

    std::array<std::int64_t, 3> count_{};
    std::vector<std::uint8_t> any_;   // of blocks, x fastest
    std::vector<std::uint8_t> rows_;  // of a block's rows of cells, y fastest: a bit for each cell
};

}  // namespace lamina

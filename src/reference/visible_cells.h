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

    // The block of a cell (CellWalk), hidden where it shows nothing. The outermost blocks hold the
    // half voxels outside the samples, too.
    CellBlock block_of(const CellIndex& cell) const {
        constexpr std::int64_t far = std::int64_t{1} << 62;
        if (any_.empty()) return {{-far, -far, -far}, {far, far, far}};
        std::array<std::int64_t, 3> number;
        CellBlock block;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            number[axis] = std::max<std::int64_t>(cell[axis], 0) / edge;
            block.first[axis] = number[axis] == 0 ? -1 : number[axis] * edge;
            block.last[axis] = number[axis] * edge + edge - 1;
        }
        const std::size_t place = place_of(number);
        block.hidden = any_[place] == 0;
        block.rows = rows_.data() + place * rows_of_block;
        return block;
    }

    // Whether a cell of a block that is not hidden may show something.
    static bool may_show(const CellBlock& block, const CellIndex& cell) {
        if (block.rows == nullptr || std::min({cell[0], cell[1], cell[2]}) < 0) return true;
        constexpr auto within = static_cast<std::uint64_t>(edge - 1);
        const auto [x, y, z] = std::array{static_cast<std::uint64_t>(cell[0]) & within,
                                          static_cast<std::uint64_t>(cell[1]) & within,
                                          static_cast<std::uint64_t>(cell[2]) & within};
        return (block.rows[z * edge + y] >> x & 1) != 0;
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

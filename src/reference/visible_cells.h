// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lamina/volume.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// The cells of a volume in memory that may be visible, and the blocks of edge^3 cells that have
// one. Block n of an axis holds the cells from n * edge - 1 on, so that the half voxels outside the
// samples are in the first block and the last. The tracer judges pictures that are drawn by
// MinMaxBricks, and so does not use these itself.
class VisibleCells {
  public:
    static constexpr std::int64_t edge = 8;

    // Without a volume it knows no cells.
    VisibleCells() = default;
    VisibleCells(const Volume& volume, const TransferIntervals& transfer);  // parallel
    static std::uint64_t bytes_for(const Grid& grid);

    bool empty() const { return cells_.empty(); }

    // Blocks along each axis.
    const std::array<std::int64_t, 3>& count() const { return count_; }
    // A bit for each block, 1 if it has such a cell: x fastest, in lines of line_bits().
    const std::uint64_t* blocks() const { return blocks_.data(); }
    std::int64_t line_bits() const { return line_words_ * 64; }
    // A bit for each cell, block by block (x fastest), x fastest in a block.
    const std::uint64_t* cells() const { return cells_.data(); }

  private:
    static constexpr std::size_t words_of_block = edge * edge * edge / 64;
    static std::array<std::int64_t, 3> blocks_of(const Grid& grid);
    static std::int64_t words_of_line(const std::array<std::int64_t, 3>& count);

    std::array<std::int64_t, 3> count_{};
    std::int64_t line_words_ = 0;
    std::vector<std::uint64_t> blocks_;
    std::vector<std::uint64_t> cells_;
};

}  // namespace lamina

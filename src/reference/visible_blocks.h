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

// Which blocks of edge^3 cells of a volume in memory have a cell that may show something. The
// tracer judges pictures that are drawn by MinMaxBricks, and so does not use these itself.
class VisibleBlocks {
  public:
    static constexpr std::int64_t edge = 8;

    // Without blocks: all may show something.
    VisibleBlocks() = default;
    VisibleBlocks(const Volume& volume, const TransferIntervals& transfer);  // parallel

    // Whether a cell (CellWalk) lies in a block that shows nothing, and the block's first and last
    // cells. The outermost blocks hold the half voxels outside the samples, too.
    bool hidden(const CellIndex& cell, CellIndex& first, CellIndex& last) const {
        if (visible_.empty()) return false;
        std::array<std::int64_t, 3> block;
        for (std::size_t axis = 0; axis < 3; ++axis)
            block[axis] = std::clamp<std::int64_t>(cell[axis], 0, edge * count_[axis] - 1) / edge;
        const std::int64_t place = (block[2] * count_[1] + block[1]) * count_[0] + block[0];
        if (visible_[static_cast<std::size_t>(place)] != 0) return false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = block[axis] == 0 ? -1 : block[axis] * edge;
            last[axis] = block[axis] * edge + edge - 1;
        }
        return true;
    }

  private:
    std::array<std::int64_t, 3> count_{};
    std::vector<std::uint8_t> visible_;  // x fastest
};

}  // namespace lamina

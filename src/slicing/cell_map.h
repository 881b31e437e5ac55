// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/sparse_bytes.h"
#include "facts/bricks.h"

namespace lamina {

// The way in which rays that walk from cell to cell pass the bricks of a volume (MinMaxBricks).
// Kind 0: cell by cell. Kind r from 1 to 63: the cube of 2 r - 1 bricks around this one shows
// nothing, and rays cross it in one step. Kind constant + r: the cube has one colour and one
// extinction.
struct CellMap {
    static constexpr int constant = 128, farthest = OccupiedBricks::farthest;

    std::array<std::int64_t, 3> count{};  // bricks along each axis
    // One byte a brick, x fastest. Empty if all bricks are of kind 0. They may be the distances of
    // OccupiedBricks themselves, which nothing changes once they are measured.
    SparseBytes kinds;
};

// `occupied`, `varied` (ConstantBricks): of the same bricks; null if they are not used.
CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied);

}  // namespace lamina

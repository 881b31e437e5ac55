// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "reference/cell_batch.h"
#include "reference/chord.h"
#include "reference/grid_axes.h"
#include "reference/lane_row.h"
#include "reference/visible_cells.h"
#include "simd/lane_set.h"

namespace lamina {

// Chords of rays on their way through cells, side by side. Each passes the same cells as CellWalk,
// with the same parameters, but for cells that show nothing.
struct CellLanes {
    static constexpr std::size_t width = longest_vector;
    // Numbers of cells are whole numbers in doubles, whose products and comparisons are quicker
    // than those of 64-bit integers. Volumes in memory have less than 2^53 cells.
    struct Axis {
        LaneRow entry, direction;
        LaneRow cell, last_cell, inverse;  // AxisStart
        // Where the chord leaves the cell along this axis, in lanes that are in a block.
        LaneRow crossing;
    };

    std::array<Axis, 3> axes;
    LaneRow from, length;  // parameters: where the chord enters the cell, and its end
    LaneSet walking = 0;
    LaneSet in_block = 0;  // those whose cell is in a block that may show something

    void stop(std::size_t lane) { walking &= ~lane_bit(lane); }
};

// A lane gets the cell in which its chord, of length > 0, begins. The lane walks from then on.
void enter_cells(CellLanes& lanes, std::size_t lane, const GridAxes& grid, const Chord& chord);

// Appends cells that may show something to the lanes' batches, until a batch is complete or some
// chords have ended. Returns those lanes; none, where none walks. `visible` must not be empty.
LaneSet walk_cells(CellLanes& lanes, const VisibleCells& visible,
                   const std::array<CellBatch*, CellLanes::width>& batches);

}  // namespace lamina

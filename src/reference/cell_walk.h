// SPDX-License-Identifier: Apache-2.0
// The cells along a chord, front to back (Amanatides and Woo 1987; docs/numerics.md, section 9.4):
//   cell = the cell in which the chord begins; from = 0
//   crossing[a] = the parameter at which the chord leaves the cell along axis a               (9.7)
//   loop:
//       to = min(least crossing, the chord's length)
//       visit (cell, from, to) if from < to
//       end if to is the chord's length
//       from = to; step to the next cell along the axis of the least crossing
// Every crossing is computed from its own plane, so errors do not accumulate. If VisibleCells are
// known, several chords walk side by side, one a lane, until a batch is complete or a chord ends:
//   1. Lanes outside visible blocks step from block to block, by the same loop, to a visible one.
//      There they find the cell in which the chord is.
//   2. Lanes in visible blocks step from cell to cell, and append visible cells to their batches.
//      When at most a quarter of the lanes is left in visible blocks, go back to 1.
#pragma once

#include "lamina/volume.h"
#include "reference/cells.h"
#include "reference/chord.h"
#include "simd/lane_set.h"

namespace lamina {

// The start of a chord along one axis: the first cell, and the grid's last one in its direction.
struct AxisStart {
    double cell, last_cell;
    double inverse;  // 1 / direction, but finite, so that 0 * inverse is 0

    // `lowest` and `highest` bound the grid's box.
    AxisStart(double lowest, double highest, double entry, double direction) {
        const double first = std::floor(lowest), last = std::ceil(highest) - 1;
        constexpr double largest = std::numeric_limits<double>::max();
        inverse = std::clamp(1 / direction, -largest, largest);
        // On a plane between two cells the ray belongs to the cell that it enters.
        cell = std::clamp(direction < 0 ? std::ceil(entry) - 1 : std::floor(entry), first, last);
        last_cell = direction < 0 ? first : direction > 0 ? last : cell;
    }
};

// Walks a single chord. Outer cells extend to the box's end, so lengths add up to the chord's.
class CellWalk {
  public:
    CellWalk(const Grid& grid, const Chord& chord) : chord_(chord) {
        const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
        for (int axis = 0; axis < 3; ++axis) {
            const double d = chord.direction[axis];
            const AxisStart start(lowest[axis], highest[axis], chord.entry[axis], d);
            inverse_[axis] = start.inverse;
            cell_[axis] = static_cast<std::int64_t>(start.cell);
            final_[axis] = static_cast<std::int64_t>(start.last_cell);
            step_[axis] = d < 0 ? -1 : 1;
            ahead_[axis] = d > 0 ? 1 : 0;
            crossing_[axis] = next_crossing(axis);
        }
    }

    // Calls visit(cell, from, to), from < to, until it returns false.
    template <typename Visit>
    void run(const Visit& visit) {
        double from = 0;
        while (true) {
            const auto& [x, y, z] = crossing_;
            const bool goes_on = x <= y ? (x <= z ? cross<0>(visit, from) : cross<2>(visit, from))
                                        : (y <= z ? cross<1>(visit, from) : cross<2>(visit, from));
            if (!goes_on) return;
        }
    }

  private:
    // Visits the current cell, left along `axis`, and steps to the next. Returns false at the end.
    template <int axis, typename Visit>
    bool cross(const Visit& visit, double& from) {
        const bool last = !(crossing_[axis] < chord_.length_z);
        const double to = last ? chord_.length_z : crossing_[axis];
        if (from < to && !visit(cell_, from, to)) return false;
        if (last) return false;
        from = std::max(from, to);
        cell_[axis] += step_[axis];
        crossing_[axis] = next_crossing(axis);
        return true;
    }

    double next_crossing(int axis) const {
        if (cell_[axis] == final_[axis]) return std::numeric_limits<double>::infinity();
        const auto plane = static_cast<double>(cell_[axis] + ahead_[axis]);
        return (plane - chord_.entry[axis]) * inverse_[axis];
    }

    const Chord& chord_;
    CellIndex cell_;
    CellIndex final_;  // the last cell of the grid in the chord's direction
    CellIndex step_;   // -1 or 1
    CellIndex ahead_;  // 0 or 1: the chord leaves the cell through the plane cell_ + ahead_
    std::array<double, 3> crossing_;  // parameters at which the chord leaves the cell, by axis
    std::array<double, 3> inverse_;   // 1 / direction, but finite
};

// Chords side by side, one a lane. Each passes the cells of CellWalk that may be visible.
struct CellLanes {
    static constexpr std::size_t width = longest_vector;
    // Numbers of cells (below 2^53) are doubles, which are quicker than 64-bit integers.
    struct Axis {
        LaneRow entry, direction;
        LaneRow cell, last_cell, inverse;  // AxisStart
        // The parameter at which the chord leaves the cell along this axis, in lanes of in_block.
        LaneRow crossing;
    };

    std::array<Axis, 3> axes;
    LaneRow from, length;  // the chord's parameter where it enters the cell, and its length
    LaneSet walking = 0;   // lanes whose chord has not ended
    LaneSet in_block = 0;  // lanes whose cell is in a block that may be visible

    void stop(std::size_t lane) { walking &= ~lane_bit(lane); }
};

// Starts a lane at the front of a chord of length > 0.
void enter_cells(CellLanes& lanes, std::size_t lane, const GridAxes& grid, const Chord& chord);

// Walks all lanes and appends visible cells to each lane's batch, until a batch is complete or a
// chord has ended. Returns the lanes for which one of these happened.
LaneSet walk_cells(CellLanes& lanes, const VisibleCells& visible,
                   const std::array<CellBatch*, CellLanes::width>& batches);

}  // namespace lamina

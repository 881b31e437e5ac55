// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "lamina/grid.h"
#include "reference/axis_start.h"
#include "reference/cell_index.h"
#include "reference/chord.h"

namespace lamina {

// The cells along a chord, front to back (Amanatides and Woo 1987). Every crossing is computed from
// its own plane, so errors do not accumulate. The first and the last cell of an axis reach to the
// end of the box, so the lengths of all cells add up to the chord.
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

    // Calls visit(cell, from, to) for every cell that the chord crosses, with its parameters from <
    // to. It ends early where visit returns false.
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
    // Visits a cell that the chord leaves along an axis.
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
    CellIndex final_;  // the last cell in the ray's direction
    CellIndex step_;   // -1 or 1
    // How far the plane through which the chord leaves a cell lies from the cell's number.
    CellIndex ahead_;
    std::array<double, 3> crossing_;
    std::array<double, 3> inverse_;  // of the direction
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "lamina/grid.h"
#include "reference/cell_block.h"
#include "reference/chord.h"

namespace lamina {

// The cells along a chord, front to back (Amanatides and Woo 1987). Cell i of an axis lies between
// samples i and i+1. On `cell` axes the cells -1 and size-1 are the half voxels outside the
// samples. Every crossing is computed from its own plane, so errors do not accumulate. The first
// and the last cell of an axis reach to the end of the box, so the lengths of all cells add up to
// the chord.
class CellWalk {
  public:
    CellWalk(const Grid& grid, const Chord& chord) : chord_(chord) {
        const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
        for (int axis = 0; axis < 3; ++axis) {
            const auto first = static_cast<std::int64_t>(std::floor(lowest[axis]));
            const auto last = static_cast<std::int64_t>(std::ceil(highest[axis])) - 1;
            const double p = chord.entry[axis], d = chord.direction[axis];
            // Finite, so that it gives 0 on the plane itself.
            constexpr double largest = std::numeric_limits<double>::max();
            inverse_[axis] = std::clamp(1 / d, -largest, largest);
            // On a plane between two cells the ray belongs to the cell that it enters.
            const double cell = d < 0 ? std::ceil(p) - 1 : std::floor(p);
            cell_[axis] = std::clamp(static_cast<std::int64_t>(cell), first, last);
            final_[axis] = d < 0 ? first : d > 0 ? last : cell_[axis];
            step_[axis] = d < 0 ? -1 : 1;
            ahead_[axis] = d > 0 ? 1 : 0;
            crossing_[axis] = next_crossing(axis);
        }
    }

    // Calls visit(cell, from, to) for every cell that the chord crosses, with its parameters from <
    // to. It ends early where visit returns false.
    template <typename Visit>
    void run(const Visit& visit) {
        const auto any_cell = [&](const CellIndex& cell, double from, double to, const CellBlock&) {
            return visit(cell, from, to);
        };
        constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
        constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
        run(any_cell, [](const CellIndex&) {
            return CellBlock{{lowest, lowest, lowest}, {highest, highest, highest}};
        });
    }

    // Calls visit(cell, from, to, block) likewise, but for cells in hidden blocks. block_of(cell)
    // returns the block of a cell.
    template <typename Visit, typename BlockOf>
    void run(const Visit& visit, const BlockOf& block_of) {
        double from = 0;
        bool goes_on = true;
        while (goes_on) {
            const CellBlock block = block_of(cell_);
            goes_on = block.hidden ? leave(block, from) : cross(block, visit, from);
        }
    }

  private:
    // Visits the cells of a block; returns whether the chord goes on behind it.
    template <typename Visit>
    bool cross(const CellBlock& block, const Visit& visit, double& from) {
        while (true) {
            const auto& [x, y, z] = crossing_;
            const Step step =
                x <= y ? (x <= z ? cross<0>(block, visit, from) : cross<2>(block, visit, from))
                       : (y <= z ? cross<1>(block, visit, from) : cross<2>(block, visit, from));
            if (step != Step::inside) return step == Step::behind;
        }
    }

    enum class Step { inside, behind, ended };

    // Visits a cell that the chord leaves along an axis.
    template <int axis, typename Visit>
    Step cross(const CellBlock& block, const Visit& visit, double& from) {
        const bool last = !(crossing_[axis] < chord_.length_z);
        const double to = last ? chord_.length_z : crossing_[axis];
        if (from < to && !visit(cell_, from, to, block)) return Step::ended;
        if (last) return Step::ended;
        from = std::max(from, to);
        cell_[axis] += step_[axis];
        crossing_[axis] = next_crossing(axis);
        return block.holds(cell_[axis], axis) ? Step::inside : Step::behind;
    }

    // Goes on from `from` to where the chord leaves a block; false where it ends before.
    bool leave(const CellBlock& block, double& from) {
        const CellIndex &first = block.first, &last = block.last;
        int leaving = -1;
        double to = chord_.length_z;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = chord_.direction[axis];
            if (d == 0) continue;
            const std::int64_t end =
                d < 0 ? std::max(first[axis], final_[axis]) : std::min(last[axis], final_[axis]);
            if (end == final_[axis]) continue;
            const double crossing = crossing_of(end + ahead_[axis], axis);
            if (crossing < to) {
                to = crossing;
                leaving = axis;
            }
        }
        if (leaving < 0) return false;
        from = std::max(from, to);
        for (int axis = 0; axis < 3; ++axis) {
            const double d = chord_.direction[axis];
            if (axis == leaving) {
                cell_[axis] = d < 0 ? first[axis] - 1 : last[axis] + 1;
            } else if (d != 0) {
                const std::int64_t before = cell_[axis];
                const double place = chord_.entry[axis] + to * d;
                const auto there =
                    static_cast<std::int64_t>(d < 0 ? std::ceil(place) - 1 : std::floor(place));
                cell_[axis] =
                    d < 0 ? std::clamp(there, std::max(first[axis], final_[axis]), cell_[axis])
                          : std::clamp(there, cell_[axis], std::min(last[axis], final_[axis]));
                // Cells are told apart by their planes' crossings, not by rounded places.
                while (cell_[axis] != before && crossing_into(axis) > to)
                    cell_[axis] -= step_[axis];
            }
            crossing_[axis] = next_crossing(axis);
        }
        return true;
    }

    double crossing_of(std::int64_t plane, int axis) const {
        return (static_cast<double>(plane) - chord_.entry[axis]) * inverse_[axis];
    }

    // Where the chord crosses the plane through which it enters the cell.
    double crossing_into(int axis) const {
        return crossing_of(cell_[axis] + 1 - ahead_[axis], axis);
    }

    double next_crossing(int axis) const {
        if (cell_[axis] == final_[axis]) return std::numeric_limits<double>::infinity();
        return crossing_of(cell_[axis] + ahead_[axis], axis);
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

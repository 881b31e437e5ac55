// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamina {

// Where a chord begins along one axis of a grid, and the last cell that it can come to. Numbers of
// cells are whole numbers.
struct AxisStart {
    double cell, last_cell;
    double inverse;  // 1 / direction, but finite, so that it gives 0 on the plane itself

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

}  // namespace lamina

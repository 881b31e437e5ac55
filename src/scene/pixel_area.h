// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace lamina {

// A rectangle of pixels: columns from the left, rows from the top of the picture. It is empty if a
// last number is below its first.
struct PixelArea {
    std::int32_t first_column, last_column, first_row, last_row;

    bool empty() const { return last_column < first_column || last_row < first_row; }
    std::int64_t count() const {
        if (empty()) return 0;
        return std::int64_t{last_column - first_column + 1} * (last_row - first_row + 1);
    }
    // Becomes the smallest rectangle around itself and another one; empty ones do not count.
    void add(const PixelArea& other) {
        if (other.empty()) return;
        if (empty()) {
            *this = other;
            return;
        }
        first_column = std::min(first_column, other.first_column);
        last_column = std::max(last_column, other.last_column);
        first_row = std::min(first_row, other.first_row);
        last_row = std::max(last_row, other.last_row);
    }
};

// The pixels that two areas have in common.
inline PixelArea common_pixels(const PixelArea& a, const PixelArea& b) {
    return {std::max(a.first_column, b.first_column), std::min(a.last_column, b.last_column),
            std::max(a.first_row, b.first_row), std::min(a.last_row, b.last_row)};
}

}  // namespace lamina

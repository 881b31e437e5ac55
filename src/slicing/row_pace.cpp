// SPDX-License-Identifier: Apache-2.0
#include "slicing/row_pace.h"

#include <algorithm>

namespace lamina {

int RowPace::next(int left) const {
    int rows = std::min(band_rows_, left);
    if (!timed_) return rows;
    // The rows at the top may show nothing, so the first frame goes ahead step by step.
    if (!known_) rows = std::min(rows, std::max(4 * last_rows_, tile_rows));
    if (ms_per_row_ > 0) {
        const double fitting = std::min<double>(wanted_ms / ms_per_row_, rows);
        rows =
            std::min(rows, std::max(static_cast<int>(fitting) / tile_rows * tile_rows, tile_rows));
    }
    return rows;
}

void RowPace::took(int rows, double ms) {
    last_rows_ = rows;
    ms_per_row_ = std::max(ms_per_row_, ms / rows);
}

// The slowest rows of the first frame are forgotten slowly, because frames have no others to show.
void RowPace::frame_took(int rows, double ms) {
    if (known_) ms_per_row_ = std::max(ms / rows, 0.9 * ms_per_row_);
    known_ = true;
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_row_bands.h"

#include <glad/gl.h>

#include <algorithm>
#include <utility>

#include "base/client.h"
#include "base/profile.h"
#include "gl/api.h"

namespace lamina {

int rows_of_band(int height, int bands, std::int64_t most) {
    constexpr int tile_rows = RowPace::tile_rows;
    const auto ceil_divide = [](int value, int divisor) { return (value + divisor - 1) / divisor; };
    const int wanted = ceil_divide(ceil_divide(height, bands), tile_rows) * tile_rows;
    const std::int64_t fitting = most >= tile_rows ? most / tile_rows * tile_rows : most;
    return static_cast<int>(std::min({fitting, std::int64_t{wanted}, std::int64_t{height}}));
}

void draw_bands(int height, RowPace& pace, const std::function<void(const RowBand&)>& draw) {
    const Stopwatch frame;
    for (int row = 0; row < height;) {
        const Stopwatch watch;
        const RowBand band{row, pace.next(height - row)};
        draw(band);
        if (pace.wants_time()) {
            gl::api().Finish();
            pace.took(band.rows, watch.milliseconds());
        }
        check_interrupt();
        row += band.rows;
    }
    if (!pace.timed()) return;
    gl::api().Finish();
    pace.frame_took(height, frame.milliseconds());
}

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
    if (!std::exchange(begun_, true)) return;
    last_rows_ = rows;
    ms_per_row_ = std::max(ms_per_row_, ms / rows);
}

// The slowest rows of the first frame are forgotten slowly, because frames have no others to show.
void RowPace::frame_took(int rows, double ms) {
    if (known_) ms_per_row_ = std::max(ms / rows, 0.9 * ms_per_row_);
    known_ = true;
}

}  // namespace lamina

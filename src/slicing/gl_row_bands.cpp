// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_row_bands.h"

#include <algorithm>

#include "base/client.h"

namespace lamina {

int rows_of_band(int height, int bands, std::int64_t most) {
    constexpr int tile_rows = RowBand::tile_rows;
    const auto ceil_divide = [](int value, int divisor) { return (value + divisor - 1) / divisor; };
    const int wanted = ceil_divide(ceil_divide(height, bands), tile_rows) * tile_rows;
    const std::int64_t fitting = most >= tile_rows ? most / tile_rows * tile_rows : most;
    return static_cast<int>(std::min({fitting, std::int64_t{wanted}, std::int64_t{height}}));
}

void draw_bands(int height, gl::WorkPace& pace, const std::function<void(const RowBand&)>& draw) {
    for (int row = 0; row < height;) {
        const RowBand band{row, pace.next(height - row)};
        draw(band);
        pace.dispatched(band.rows);
        check_interrupt();
        row += band.rows;
    }
}

}  // namespace lamina

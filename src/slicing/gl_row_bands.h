// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "gl/pace.h"

namespace lamina {

// Rows of a picture, row 0 at the top.
struct RowBand {
    static constexpr int tile_rows = 8;  // of shaders/gl/tile.glsl

    int first_row = 0, rows = 0;
};

// Returns the largest number of rows, at most `height`, that take at most `most` times as many
// bytes as a row, and which are of whole tiles of gl/pixels.glsl if they hold one. `bands`: into
// how many bands the picture is to be divided at least.
int rows_of_band(int height, int bands, std::int64_t most);

// Draws a picture, band after band, by `draw(band)`. Ctrl-C ends it between bands. `pace` counts
// rows, and its frame has begun.
void draw_bands(int height, gl::WorkPace& pace, const std::function<void(const RowBand&)>& draw);

}  // namespace lamina

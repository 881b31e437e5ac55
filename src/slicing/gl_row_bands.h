// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

namespace lamina {

// Rows of a picture, row 0 at the top.
struct RowBand {
    int first_row = 0, rows = 0;
};

// Returns the largest number of rows, at most `height`, that take at most `most` times as many
// bytes as a row, and which are of whole tiles of gl/pixels.glsl if they hold one. `bands`: into
// how many bands the picture is to be divided at least.
int rows_of_band(int height, int bands, std::int64_t most);

// Chooses how many rows of a picture a GPU draws in one dispatch, by the time that rows took
// before: drivers end programs that take seconds, and a desktop stands still until a dispatch is
// done. Software is given bands of a fixed number of rows, and needs no clock.
class RowPace {
  public:
    // Time in milliseconds for which rows are chosen: half of the most that a dispatch should take,
    // because the next view may show more.
    static constexpr double wanted_ms = 50;
    static constexpr int tile_rows = 8;  // of shaders/gl/tile.glsl

    // `band_rows`: most rows that fit the memory. `timed`: false for bands of so many rows.
    RowPace(int band_rows, bool timed) : band_rows_(band_rows), timed_(timed) {}

    // Returns the number of rows to draw next, of `left` that remain.
    int next(int left) const;
    // Tells whether the rows must be waited for, and took() be called with the time they took: in
    // the first frame, which begins with few rows.
    bool wants_time() const { return timed_ && !known_; }
    // The first of these times is ignored: the program's first use may have cost more.
    void took(int rows, double ms);
    // Must be called once a frame is done.
    void frame_took(int rows, double ms);
    bool timed() const { return timed_; }

  private:
    int band_rows_;
    bool timed_, known_ = false;
    bool begun_ = false;     // the first band of all is drawn
    int last_rows_ = 0;      // in the first frame
    double ms_per_row_ = 0;  // of the slowest rows so far
};

// Draws a picture, band after band, by `draw(band)`. Ctrl-C ends it between bands.
void draw_bands(int height, RowPace& pace, const std::function<void(const RowBand&)>& draw);

}  // namespace lamina

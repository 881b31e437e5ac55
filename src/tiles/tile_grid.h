// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace lamina {

// A picture cut into squares that are drawn one after the other or at the same time, each by one
// task. Rows run downwards from the picture's top.
class TileGrid {
  public:
    static constexpr int edge = 32;  // pixels of a tile
    static constexpr int block = 4;  // pixels of a block: vectors are whole blocks or rows of one
    static constexpr int pixels = edge * edge;

    // The part of the picture that a tile covers; tiles at the right and at the bottom stick out.
    struct Tile {
        int column, row;    // of its first pixel
        int width, height;  // inside the picture
    };

    TileGrid(int width, int height)
        : width_(width),
          height_(height),
          columns_((width + edge - 1) / edge),
          rows_((height + edge - 1) / edge) {}

    int width() const { return width_; }
    int height() const { return height_; }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    int count() const { return columns_ * rows_; }
    Tile tile(int number) const {
        const int column = number % columns_ * edge, row = number / columns_ * edge;
        return {column, row, std::min(edge, width_ - column), std::min(edge, height_ - row)};
    }

    // Where a tile keeps its pixel (column, row), both 0..edge-1: block by block, in a block row by
    // row. So 4, 8 or 16 pixels that follow each other are 4 x 1, 4 x 2 or 4 x 4.
    static constexpr int place(int column, int row) {
        const int number = row / block * (edge / block) + column / block;
        return number * block * block + row % block * block + column % block;
    }
    // The pixel that it keeps there.
    struct Place {
        int column, row;
    };
    static constexpr Place pixel_at(int place) {
        constexpr int per_row = edge / block;
        const int number = place / (block * block), rest = place % (block * block);
        return {number % per_row * block + rest % block, number / per_row * block + rest / block};
    }

  private:
    int width_, height_, columns_, rows_;
};

}  // namespace lamina

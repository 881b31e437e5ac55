// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace lamina {

// A picture cut into squares (tiles). Each tile is drawn by one task, and tasks may run at the same
// time. Rows run downwards from the picture's top.
class TileGrid {
  public:
    static constexpr int edge = 32;  // pixels of a tile
    static constexpr int block = 4;  // pixels of a block; a vector is a whole block or rows of one
    static constexpr int pixels = edge * edge;

    // The pixels that a tile covers. Tiles at the right and lower edge may reach beyond the
    // picture.
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

    // Returns the place at which a tile stores its pixel (column, row), both 0..edge-1. Blocks
    // follow each other, and a block is stored row by row. So 4, 8 or 16 consecutive pixels are 4 x
    // 1, 4 x 2 or 4 x 4 pixels of the picture.
    static constexpr int place(int column, int row) {
        const int number = row / block * (edge / block) + column / block;
        return number * block * block + row % block * block + column % block;
    }
    // Returns the pixel at a place: the inverse of place().
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

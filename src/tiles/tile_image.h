// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "compositing/codes.h"
#include "lamina/image.h"
#include "plan/compositing_plan.h"

namespace lamina {

// A picture cut into squares (tiles), each drawn by one task. Rows run downwards from the top.
class TileGrid {
  public:
    static constexpr int edge = 32;  // pixels of a tile
    static constexpr int block = 4;  // pixels; a vector holds a block or some of its rows
    static constexpr int pixels = edge * edge;

    // The pixels of a tile. Tiles at the right and lower edge may reach beyond the picture.
    struct Tile {
        int column, row;    // of its first pixel, in the picture
        int width, height;  // of the part inside the picture
    };

    TileGrid(int width, int height)
        : width_(width),
          height_(height),
          columns_((width + edge - 1) / edge),
          rows_((height + edge - 1) / edge) {}

    int width() const { return width_; }
    int height() const { return height_; }
    int columns() const { return columns_; }
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

// One number for each pixel of a tile, at TileGrid::place().
struct alignas(64) TilePlane : std::array<float, TileGrid::pixels> {};

// The pixels of one tile: associated colour and opacity. Fixed-point targets store codes, which
// floats hold exactly.
struct TilePixels {
    using Plane = TilePlane;
    Plane red, green, blue, alpha;
};

// A picture in tiles. It allocates its memory once.
class TileImage {
  public:
    TileImage(int width, int height);

    const TileGrid& grid() const { return grid_; }
    TilePixels& tile(int number) { return tiles_[static_cast<std::size_t>(number)]; }
    const TilePixels& tile(int number) const { return tiles_[static_cast<std::size_t>(number)]; }
    // Copies the picture to `image`. `largest_code`: the number in the tiles that stands for 1; it
    // is 1 if the tiles hold values and not codes.
    void read(float largest_code, Image& image) const;
    std::int64_t byte_count() const {
        return grid_.count() * static_cast<std::int64_t>(sizeof(TilePixels));
    }

  private:
    TileGrid grid_;
    std::unique_ptr<TilePixels[]> tiles_;
};

// The plan's choices for compositing onto a tile, as tiles/target_pixels-inl.h uses them.
struct TargetBlend {
    Target target = Target::float32;
    int bits = 8;       // bits of a code, for targets with codes
    float largest = 1;  // value that stands for 1 in the tiles: the largest code, or 1
    Order order = Order::back_to_front;
    AlphaRounding alpha_rounding = AlphaRounding::truncate;
    OverRounding over_rounding = OverRounding::separate;
    std::uint32_t seed = 1;  // of stochastic rounding
};

TargetBlend target_blend(const CompositingPlan& plan);

}  // namespace lamina

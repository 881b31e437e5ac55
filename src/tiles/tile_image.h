// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "compositing/codes.h"
#include "lamina/image.h"
#include "tiles/tile_grid.h"

namespace lamina {

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
    // `largest_code`: the number that stands for 1; it is 1 if the tiles hold values.
    void read(float largest_code, Image& image) const;
    std::int64_t byte_count() const {
        return grid_.count() * static_cast<std::int64_t>(sizeof(TilePixels));
    }

  private:
    TileGrid grid_;
    std::unique_ptr<TilePixels[]> tiles_;
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts/volume_facts.h"
#include "lamina/grid.h"
#include "scene/camera.h"
#include "tiles/tile_grid.h"

namespace lamina {

// Pixels of a picture.
struct PixelBox {
    int first_column = 0, end_column = 0, first_row = 0, end_row = 0;

    bool meets(const TileGrid::Tile& tile) const {
        return tile.column < end_column && tile.column + TileGrid::edge > first_column &&
               tile.row < end_row && tile.row + TileGrid::edge > first_row;
    }
    PixelBox joined(const PixelBox& other) const;
    PixelBox common(const PixelBox& other) const;
};

// Returns the pixels whose rays meet a box of the grid's index space, and some around them.
PixelBox pixels_of(const IndexBox& box, const Grid& grid, const View& view);

}  // namespace lamina

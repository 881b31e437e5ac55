// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "lamina/image.h"
#include "lamina/picture_tile.h"
#include "reference/pixels_in_turn.h"

namespace lamina {

// Hears which tile of the picture is complete. It is called by one thread at a time; the other
// pixels of the picture have no meaning yet, or are being written.
using TileDone = std::function<void(const PictureTile&, const PreciseImage&)>;

// Tiles of 32 x 32 pixels and what is left at the edges, those nearest the middle first.
std::vector<PictureTile> tiles_to_trace(int width, int height);

// Calls trace(tile, its number, row done) for each of them on all cores, in their order, and then
// `done`.
void trace_tiles(const std::vector<PictureTile>& tiles,
                 const std::function<void(const PictureTile&, std::size_t, const RowDone&)>& trace,
                 const PreciseImage& picture, const TileDone& done);

}  // namespace lamina

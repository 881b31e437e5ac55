// SPDX-License-Identifier: Apache-2.0
// The pixels of a vector: 4 x 1, 4 x 2 or 4 x 4 of a tile, row by row (TileGrid::place()).
#if defined(LAMINA_TILES_LANE_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_LANE_PIXELS_INL_H_
#undef LAMINA_TILES_LANE_PIXELS_INL_H_
#else
#define LAMINA_TILES_LANE_PIXELS_INL_H_
#endif

#include <cstdint>

#include "tiles/random_bits-inl.h"
#include "tiles/tile_grid.h"

LAMINA_SIMD_BEGIN

static_assert(TileGrid::block == 4);

// The distance from the first pixel to each pixel, as whole numbers.
LAMINA_INLINE Word lane_columns() {
    return iota<Word>(0) & 3u;
}
LAMINA_INLINE Word lane_rows() {
    return shift_right<2>(iota<Word>(0));
}

// Returns random bits for the pixels of a vector whose first pixel is (column, row) of the picture,
// rows from the top.
LAMINA_INLINE Word random_of_pixels(int column, int row, std::uint32_t sample, std::uint32_t seed) {
    return random_bits(static_cast<std::uint32_t>(column) + lane_columns(),
                       static_cast<std::uint32_t>(row) + lane_rows(), Word(sample), Word(seed));
}

LAMINA_SIMD_END

#endif

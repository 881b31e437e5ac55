// SPDX-License-Identifier: Apache-2.0
// The pixels of a vector: 4 x 1, 4 x 2 or 4 x 4 of a tile, row by row (TileGrid::place()).
#if defined(LAMINA_TILES_LANE_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_LANE_PIXELS_INL_H_
#undef LAMINA_TILES_LANE_PIXELS_INL_H_
#else
#define LAMINA_TILES_LANE_PIXELS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "tiles/random_bits-inl.h"
#include "tiles/tile_grid.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

static_assert(TileGrid::block == 4);

// The distance from the first pixel to each pixel, as whole numbers.
template <class DU>
HWY_INLINE hn::Vec<DU> lane_columns(DU d) {
    return hn::And(hn::Iota(d, 0), hn::Set(d, 3u));
}
template <class DU>
HWY_INLINE hn::Vec<DU> lane_rows(DU d) {
    return hn::ShiftRight<2>(hn::Iota(d, 0));
}

// The pixels of a vector whose first pixel is (column, row) of the picture, rows from the top.
template <class DU>
HWY_INLINE hn::Vec<DU> random_of_pixels(DU d, int column, int row, std::uint32_t sample,
                                        std::uint32_t seed) {
    const auto from = [d](int pixel)
                          HWY_ATTR { return hn::Set(d, static_cast<std::uint32_t>(pixel)); };
    return random_bits(d, hn::Add(from(column), lane_columns(d)), hn::Add(from(row), lane_rows(d)),
                       hn::Set(d, sample), hn::Set(d, seed));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

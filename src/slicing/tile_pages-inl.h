// SPDX-License-Identifier: Apache-2.0
// Where the samples of cells lie: beside each other in memory, or in pages that are read when they
// are needed (slicing/tile_pages.h).
#if defined(LAMINA_SLICING_TILE_PAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_PAGES_INL_H_
#undef LAMINA_SLICING_TILE_PAGES_INL_H_
#else
#define LAMINA_SLICING_TILE_PAGES_INL_H_
#endif

#include <algorithm>
#include <cstring>

#include "simd/vectors-inl.h"
#include "slicing/tile_volume.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE Int page_index(const TilePages& pages, Int x, Int y, Int z) {
    constexpr int bits = TilePages::place_bits;
    const Int within(TilePages::places);
    x += pages.offset[0];
    y += pages.offset[1];
    z += pages.offset[2];
    const Int page = shift_right<bits>(x) +
                     (shift_right<bits>(y) * pages.row + shift_right<bits>(z) * pages.slice);
    const Int place =
        (x & within) | (shift_left<bits>(y & within) | shift_left<2 * bits>(z & within));
    return shift_left<TilePages::page_bits>(page) | place;
}

// The index by which a cell's samples are fetched; x, y, z: its lowest corner.
LAMINA_INLINE Int cell_index(const TileBrick& brick, Int x, Int y, Int z) {
    if (brick.pages != nullptr) [[unlikely]]
        return page_index(*brick.pages, x, y, z);
    return x + (y * brick.row + z * brick.slice);
}

// Calls visit(i, begin of the page, place in it) for cells 0 .. count - 1, with their pages in
// memory.
template <class Visit>
LAMINA_INLINE void visit_pages(const TilePages& pages, const std::int32_t* indices,
                               std::size_t count, const Visit& visit) {
    for (std::size_t from = 0; from < count; from += BrickCache::most_held) {
        const std::size_t end = std::min(count, from + BrickCache::most_held);
        const auto held = pages.cache->hold(
            end - from, [&](std::size_t i) { return pages.number_of(indices[from + i]); });
        for (std::size_t i = from; i < end; ++i)
            visit(i, pages.cache->at(pages.number_of(indices[i])), TilePages::place_of(indices[i]));
    }
}

// The four pairs of neighbours along x of each cell, as fetch_pairs() has them.
template <class Pair, std::size_t size>
inline LAMINA_NOINLINE void fetch_paged_pairs(const TilePages& pages, const std::int32_t* indices,
                                              std::size_t count, Pair (&pairs)[4][size]) {
    constexpr std::size_t bytes = sizeof(Pair) / 2;
    constexpr std::size_t row = bytes * static_cast<std::size_t>(BrickCache::row);
    constexpr std::size_t slice = bytes * static_cast<std::size_t>(BrickCache::slice);
    visit_pages(pages, indices, count,
                [&](std::size_t i, const std::byte* page, std::size_t place) {
                    const std::byte* const at = page + bytes * place;
                    std::memcpy(&pairs[0][i], at, sizeof(Pair));
                    std::memcpy(&pairs[1][i], at + row, sizeof(Pair));
                    std::memcpy(&pairs[2][i], at + slice, sizeof(Pair));
                    std::memcpy(&pairs[3][i], at + slice + row, sizeof(Pair));
                });
}

LAMINA_SIMD_END

#endif

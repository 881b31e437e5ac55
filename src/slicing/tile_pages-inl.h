// SPDX-License-Identifier: Apache-2.0
// Where the samples of cells lie: beside each other in memory, or in pages that are read when they
// are needed (slicing/tile_pages.h).
#if defined(LAMINA_SLICING_TILE_PAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_PAGES_INL_H_
#undef LAMINA_SLICING_TILE_PAGES_INL_H_
#else
#define LAMINA_SLICING_TILE_PAGES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "executors/tile_number-inl.h"
#include "slicing/tile_volume.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

HWY_INLINE Ints page_index(const TilePages& pages, Ints x, Ints y, Ints z) {
    constexpr int bits = TilePages::place_bits;
    const IntTag di;
    const Ints within = hn::Set(di, TilePages::places);
    x = hn::Add(x, hn::Set(di, pages.offset[0]));
    y = hn::Add(y, hn::Set(di, pages.offset[1]));
    z = hn::Add(z, hn::Set(di, pages.offset[2]));
    const Ints page = hn::Add(hn::ShiftRight<bits>(x),
                              hn::Add(hn::Mul(hn::ShiftRight<bits>(y), hn::Set(di, pages.row)),
                                      hn::Mul(hn::ShiftRight<bits>(z), hn::Set(di, pages.slice))));
    const Ints place =
        hn::Or(hn::And(x, within), hn::Or(hn::ShiftLeft<bits>(hn::And(y, within)),
                                          hn::ShiftLeft<2 * bits>(hn::And(z, within))));
    return hn::Or(hn::ShiftLeft<TilePages::page_bits>(page), place);
}

// The index by which a cell's samples are fetched; x, y, z: its lowest corner.
HWY_INLINE Ints cell_index(const TileBrick& brick, Ints x, Ints y, Ints z) {
    const IntTag di;
    if (HWY_UNLIKELY(brick.pages != nullptr)) return page_index(*brick.pages, x, y, z);
    return hn::Add(
        x, hn::Add(hn::Mul(y, hn::Set(di, brick.row)), hn::Mul(z, hn::Set(di, brick.slice))));
}

// Calls visit(i, begin of the page, place in it) for cells 0 .. count - 1, with their pages in
// memory.
template <class Visit>
HWY_INLINE void visit_pages(const TilePages& pages, const std::int32_t* indices, std::size_t count,
                            const Visit& visit) {
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
inline HWY_NOINLINE void fetch_paged_pairs(const TilePages& pages, const std::int32_t* indices,
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

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

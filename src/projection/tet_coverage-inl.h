// SPDX-License-Identifier: Apache-2.0
// The pixels of a tile whose rays meet a cell fragment, and the depths at which the rays meet it.
#if defined(LAMINA_PROJECTION_TET_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#undef LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#else
#define LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "projection/fragment_queue-inl.h"

LAMINA_SIMD_BEGIN

// Returns the blocks of a tile that an area of the picture touches: one bit a block, row by row.
inline std::uint64_t blocks_of(const PartArea& area, const TileGrid::Tile& tile) {
    constexpr int a_row = TileGrid::edge / TileGrid::block;
    const auto in_tile = [](int pixel, int first) {
        return std::clamp(pixel - first, 0, TileGrid::edge - 1) / TileGrid::block;
    };
    const int first_column = in_tile(area.first_column, tile.column),
              last_column = in_tile(area.last_column, tile.column);
    const int first_row = in_tile(area.first_row, tile.row),
              last_row = in_tile(area.last_row, tile.row);
    const std::uint64_t columns =
        (0xffull >> (a_row - 1 - last_column)) & (0xffull << first_column);
    const std::uint64_t rows =
        (~0ull >> a_row * (a_row - 1 - last_row)) & (~0ull << a_row * first_row);
    return rows & (columns * 0x0101010101010101ull);
}

// Calls visit(column, row) with the first pixel of each block in the set.
template <class Visit>
LAMINA_INLINE void for_each_block(std::uint64_t blocks, const Visit& visit) {
    constexpr int a_row = TileGrid::edge / TileGrid::block;
    for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
        const int number = std::countr_zero(left);
        visit(number % a_row * TileGrid::block, number / a_row * TileGrid::block);
    }
}

class TetCoverage {
  public:
    TetCoverage(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile), area_(tile.area) {}

    // Returns the blocks of the tile that a cell fragment may cover: one bit a block, row by row.
    LAMINA_INLINE std::uint64_t blocks(const PartArea& area) const {
        return blocks_of(area, area_) & blocks_within(area);
    }

    // `cut`: the cell fragment ends at planes of constant scalar. `lit`: the fragments found are
    // lit.
    template <bool lit>
    LAMINA_INLINE void find(bool cut, const SilhouetteRecord& record, const PartArea& area,
                            std::uint64_t blocks, std::size_t part, FragmentQueue& found) {
        // Blocks at the picture's right and lower edge may stick out of it.
        const bool whole_blocks = area_.width % block == 0 && area_.height % block == 0;
        FragmentQueue::Writer writer(found, part);
        if (has_exact_runs(fragments_, area)) {
            find_in<true, true, CarefulDepths>(cut, record, area, blocks, writer);
        } else if (area.careful) {
            find_in<lit, true, CarefulDepths>(cut, record, area, blocks, writer);
        } else if (area.bounded || !whole_blocks) {
            find_in<lit, true, PlainDepths>(cut, record, area, blocks, writer);
        } else {
            find_in<lit, false, PlainDepths>(cut, record, area, blocks, writer);
        }
        count_ += static_cast<std::int64_t>(writer.finish());
    }
    std::int64_t fragments() const { return count_; }

  private:
    static constexpr int block = TileGrid::block, blocks_a_row = TileGrid::edge / TileGrid::block;

    float from_column(const SeenTet& record) const {
        return static_cast<float>(area_.column) + 0.5f - record.center[0];
    }
    float from_row(const SeenTet& record) const {
        return static_cast<float>(fragments_.image_rows - area_.row) - 0.5f - record.center[1];
    }

    // Returns the tile's blocks within the outline of a cell fragment, one bit a block.
    LAMINA_INLINE std::uint64_t blocks_within(const PartArea& area) const {
        constexpr float a_block = 1.0f / block;
        const auto pixels = [](std::int32_t from, std::int32_t to) {
            return static_cast<float>(to - from);
        };
        // Bounds in blocks from the tile's first block, plus one half: rounding then gives the next
        // whole number after the bound.
        const Float4 per_row = load_unaligned<Float4>(area.outline.per_row.data());
        const Float4 bound = (load_unaligned<Float4>(area.outline.at_first.data()) +
                              per_row * pixels(area.first_row, area_.row) -
                              pixels(area.first_column, area_.column)) *
                                 a_block +
                             0.5f;
        const auto is_least = mask_of_bits<Float4::Mask>(area.outline.least);
        constexpr float beyond = blocks_a_row;
        alignas(16) float least[4], least_per_row[4], greatest[4], greatest_per_row[4];
        store(zero_unless(is_least, bound), least);
        store(zero_unless(is_least, per_row), least_per_row);
        store(select(is_least, beyond, bound), greatest);
        store(zero_if(is_least, per_row), greatest_per_row);
        // The bits of a float of at least 2^23 count whole numbers.
        const auto whole = [](Float8 v) LAMINA_LAMBDA { return bits_as<Word8>(v + 0x1p23f); };
        const auto power = [&](Float8 v) LAMINA_LAMBDA {
            return bits_as<Float8>(shift_left<23>(whole(v) + 127u));
        };
        std::uint8_t bits[blocks_a_row];
        for (std::size_t row = 0; row < blocks_a_row; row += Float8::lanes) {
            const Float8 rows = iota<Float8>(static_cast<float>(row));
            Float8 first(0), end(beyond);
            for (std::size_t i = 0; i < 4; ++i) {
                first = max(first, least[i] + least_per_row[i] * rows);
                end = min(end, greatest[i] + greatest_per_row[i] * rows);
            }
            first = min(first, beyond);
            end = max(end, 0);
            // 2^end - 2^first has the bits from `first` up to `end`.
            const Float8 some = max(power(end) - power(first), 0);
            store_low_bytes(whole(some), bits + row);
        }
        std::uint64_t within;
        std::memcpy(&within, bits, sizeof(within));
        return within;
    }

    // Prefetches the pixels of a block into the cache before its fragments are put there.
    LAMINA_INLINE void prefetch_pixels(std::size_t first) const {
        if (tile_.pixels == nullptr) return;
        __builtin_prefetch(tile_.pixels->red.data() + first);
        __builtin_prefetch(tile_.pixels->green.data() + first);
        __builtin_prefetch(tile_.pixels->blue.data() + first);
        __builtin_prefetch(tile_.pixels->alpha.data() + first);
    }

    // `placed`: the queue gets the places of pixels.
    template <bool placed, bool bounded, class Depths>
    LAMINA_INLINE void find_in(bool cut, const SilhouetteRecord& record, const PartArea& area,
                               std::uint64_t blocks, FragmentQueue::Writer& writer) const {
        constexpr int rows_a_vector = static_cast<int>(FragmentQueue::lanes) / block;
        const float first_column = from_column(record.seen()), first_row = from_row(record.seen());
        const auto column_of = [&](int pixel) {
            return first_column + static_cast<float>(pixel - area_.column);
        };
        const auto row_of = [&](int pixel) {
            return first_row - static_cast<float>(pixel - area_.row);
        };
        const float first_in = column_of(area.first_column), last_in = column_of(area.last_column);
        const float highest = row_of(area.first_row), lowest = row_of(area.last_row);
        // These are read before the loop, because for all that the compiler knows the loop's writes
        // could overwrite the record.
        const Float scalar_per_column(record.seen().scalar_per_column),
            scalar_per_row(record.seen().scalar_per_row);
        const float* const slants = tile_.slants;
        const Depths depths(fragments_, record);
        const PartCuts cuts(cut, record.fragment);
        for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(left));
            prefetch_pixels(number * block * block);
            const Float columns = first_column + load<Float>(block_columns.data() +
                                                             number % blocks_a_row * block * block);
            const auto at_columns = depths.at_columns(columns);
            for (int y = 0; y < block; y += rows_a_vector) {
                const std::size_t step = static_cast<std::size_t>(y) * block;
                const Float rows = first_row - load<Float>(block_rows.data() + step +
                                                           number / blocks_a_row * block * block);
                InsideSpan<Float> span = depths.at(at_columns, rows);
                if constexpr (bounded) span.leave = min(span.leave, area.farthest);
                cuts.shorten(record.fragment, columns, rows, span);
                FloatMask inside = span.leave > span.enter;
                if constexpr (bounded) {
                    const FloatMask in_columns = (columns >= first_in) & (columns <= last_in);
                    const FloatMask in_rows = (rows >= lowest) & (rows <= highest);
                    inside = inside & (in_columns & in_rows);
                }
                const std::size_t place = number * block * block + step;
                if constexpr (placed) {
                    writer.add(place, PlacedRay{span, columns, rows}, inside);
                    continue;
                }
                const Float slant = slants != nullptr ? load<Float>(slants + place) : Float(1);
                const Float aside = columns * scalar_per_column + rows * scalar_per_row;
                writer.add(place, SlantedRay{span, aside, slant}, inside);
            }
        }
    }

    // One number for each pixel of the blocks in a row or a column of blocks, counted from the
    // tile's first pixel.
    struct alignas(64) PixelRow : std::array<float, TileGrid::edge * TileGrid::block> {};
    static constexpr PixelRow block_columns = [] {
        PixelRow columns{};
        for (int i = 0; i < TileGrid::edge * block; ++i)
            columns[static_cast<std::size_t>(i)] =
                static_cast<float>(i / (block * block) * block + i % block);
        return columns;
    }();
    static constexpr PixelRow block_rows = [] {
        PixelRow rows{};
        for (int i = 0; i < TileGrid::edge * block; ++i)
            rows[static_cast<std::size_t>(i)] = static_cast<float>(i / block);
        return rows;
    }();

    const TetFragments& fragments_;
    const TetTile& tile_;
    const TileGrid::Tile& area_;
    std::int64_t count_ = 0;
};

LAMINA_SIMD_END

#endif

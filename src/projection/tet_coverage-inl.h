// SPDX-License-Identifier: Apache-2.0
// Which pixels of a tile have rays that meet a cell fragment, and where the rays meet it.
#if defined(LAMINA_PROJECTION_TET_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#undef LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#else
#define LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "projection/fragment_queue-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The blocks of a tile that an area of the picture touches: one bit a block, row by row.
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
HWY_INLINE void for_each_block(std::uint64_t blocks, const Visit& visit) {
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

    // The blocks of the tile that a cell fragment may cover: one bit a block, row by row.
    HWY_INLINE std::uint64_t blocks(const PartArea& area) const {
        return blocks_of(area, area_) & blocks_within(area);
    }

    // `cut`: the cell fragment ends at planes of constant scalar. `lit`: what is found is.
    template <bool lit>
    HWY_INLINE void find(bool cut, const TetRecord& record, const PartArea& area,
                         std::uint64_t blocks, std::size_t part, FragmentQueue& found) {
        // Blocks at the picture's right and lower edge may stick out of it.
        const bool whole_blocks = area_.width % block == 0 && area_.height % block == 0;
        FragmentQueue::Writer writer(found, part);
        if (has_exact_runs(fragments_, area)) {
            find_in<true, true, CarefulDepths<Tag>>(cut, record, area, blocks, writer);
        } else if (area.careful) {
            find_in<lit, true, CarefulDepths<Tag>>(cut, record, area, blocks, writer);
        } else if (area.bounded || !whole_blocks) {
            find_in<lit, true, PlainDepths<Tag>>(cut, record, area, blocks, writer);
        } else {
            find_in<lit, false, PlainDepths<Tag>>(cut, record, area, blocks, writer);
        }
        count_ += static_cast<std::int64_t>(writer.finish(d_));
    }
    std::int64_t fragments() const { return count_; }

  private:
    static constexpr int block = TileGrid::block, blocks_a_row = TileGrid::edge / TileGrid::block;

    float from_column(const TetRecord& record) const {
        return static_cast<float>(area_.column) + 0.5f - record.center[0];
    }
    float from_row(const TetRecord& record) const {
        return static_cast<float>(fragments_.image_rows - area_.row) - 0.5f - record.center[1];
    }

    // The tile's blocks within the outline of a cell fragment, one bit a block.
    HWY_INLINE std::uint64_t blocks_within(const PartArea& area) const {
        const hn::FixedTag<float, 4> d4;
        const auto a_block = hn::Set(d4, 1.0f / block);
        const auto pixels = [&](std::int32_t from, std::int32_t to)
                                HWY_ATTR { return hn::Set(d4, static_cast<float>(to - from)); };
        // Bounds in blocks from the tile's first block, plus one half: rounding then gives the next
        // whole number after the bound.
        const auto per_row = hn::LoadU(d4, area.outline.per_row.data());
        const auto bound =
            hn::Add(hn::Mul(hn::Sub(hn::Add(hn::LoadU(d4, area.outline.at_first.data()),
                                            hn::Mul(per_row, pixels(area.first_row, area_.row))),
                                    pixels(area.first_column, area_.column)),
                            a_block),
                    hn::Set(d4, 0.5f));
        const auto is_least = hn::LoadMaskBits(d4, &area.outline.least);
        constexpr float beyond = blocks_a_row;
        alignas(16) float least[4], least_per_row[4], greatest[4], greatest_per_row[4];
        hn::Store(hn::IfThenElseZero(is_least, bound), d4, least);
        hn::Store(hn::IfThenElseZero(is_least, per_row), d4, least_per_row);
        hn::Store(hn::IfThenElse(is_least, hn::Set(d4, beyond), bound), d4, greatest);
        hn::Store(hn::IfThenZeroElse(is_least, per_row), d4, greatest_per_row);
        const hn::CappedTag<float, blocks_a_row> d;
        const hn::RebindToUnsigned<decltype(d)> du;
        const hn::Rebind<std::uint8_t, decltype(d)> d8;
        // The bits of a float of at least 2^23 count whole numbers.
        const auto whole = [&](auto v) HWY_ATTR {
            return hn::BitCast(du, hn::Add(v, hn::Set(d, 0x1p23f)));
        };
        const auto power = [&](auto v) HWY_ATTR {
            return hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(whole(v), hn::Set(du, 127))));
        };
        std::uint8_t bits[blocks_a_row];
        for (std::size_t row = 0; row < blocks_a_row; row += hn::Lanes(d)) {
            const auto rows = hn::Iota(d, static_cast<float>(row));
            auto first = hn::Zero(d), end = hn::Set(d, beyond);
            for (std::size_t i = 0; i < 4; ++i) {
                first = hn::Max(first, at_row(d, hn::Set(d, least[i]), least_per_row[i], rows));
                end = hn::Min(end, at_row(d, hn::Set(d, greatest[i]), greatest_per_row[i], rows));
            }
            first = hn::Min(first, hn::Set(d, beyond));
            end = hn::Max(end, hn::Zero(d));
            // 2^end - 2^first has the bits from `first` up to `end`.
            const auto some = hn::Max(hn::Sub(power(end), power(first)), hn::Zero(d));
            hn::StoreU(hn::TruncateTo(d8, whole(some)), d8, bits + row);
        }
        std::uint64_t within;
        std::memcpy(&within, bits, sizeof(within));
        return within;
    }

    // Prefetches the pixels of a block into the cache before its fragments are put there.
    HWY_INLINE void prefetch_pixels(std::size_t first) const {
        if (tile_.pixels == nullptr) return;
        hwy::Prefetch(tile_.pixels->red.data() + first);
        hwy::Prefetch(tile_.pixels->green.data() + first);
        hwy::Prefetch(tile_.pixels->blue.data() + first);
        hwy::Prefetch(tile_.pixels->alpha.data() + first);
    }

    // `places`: the queue gets the places of pixels.
    template <bool places, bool bounded, class Depths>
    HWY_INLINE void find_in(bool cut, const TetRecord& record, const PartArea& area,
                            std::uint64_t blocks, FragmentQueue::Writer& writer) const {
        constexpr int rows_a_vector = static_cast<int>(FragmentQueue::lanes) / block;
        const float first_column = from_column(record), first_row = from_row(record);
        const auto column_of = [&](int pixel) HWY_ATTR {
            return hn::Set(d_, first_column + static_cast<float>(pixel - area_.column));
        };
        const auto row_of = [&](int pixel) HWY_ATTR {
            return hn::Set(d_, first_row - static_cast<float>(pixel - area_.row));
        };
        const Vector first_in = column_of(area.first_column), last_in = column_of(area.last_column);
        const Vector highest = row_of(area.first_row), lowest = row_of(area.last_row);
        const Vector start_column = hn::Set(d_, first_column), start_row = hn::Set(d_, first_row);
        const Vector scalar_per_column = hn::Set(d_, record.scalar_per_column),
                     scalar_per_row = hn::Set(d_, record.scalar_per_row);
        const float* const slants = tile_.slants;
        const Depths depths(d_, fragments_, record);
        const PartCuts cuts(cut, record);
        for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(left));
            prefetch_pixels(number * block * block);
            const Vector columns =
                hn::Add(start_column,
                        hn::Load(d_, block_columns.data() + number % blocks_a_row * block * block));
            const auto at_columns = depths.at_columns(d_, columns);
            for (int y = 0; y < block; y += rows_a_vector) {
                const std::size_t step = static_cast<std::size_t>(y) * block;
                const Vector rows = hn::Sub(
                    start_row,
                    hn::Load(d_, block_rows.data() + step + number / blocks_a_row * block * block));
                InsideSpan<Vector> span = depths.at(d_, at_columns, rows);
                if constexpr (bounded) span.leave = hn::Min(span.leave, hn::Set(d_, area.farthest));
                cuts.shorten(d_, record, columns, rows, span);
                auto inside = hn::Gt(span.leave, span.enter);
                if constexpr (bounded) {
                    const auto in_columns =
                        hn::And(hn::Ge(columns, first_in), hn::Le(columns, last_in));
                    const auto in_rows = hn::And(hn::Ge(rows, lowest), hn::Le(rows, highest));
                    inside = hn::And(inside, hn::And(in_columns, in_rows));
                }
                const std::size_t place = number * block * block + step;
                if constexpr (places) {
                    writer.add(d_, place, {span, columns, rows}, inside);
                    continue;
                }
                const Vector slant =
                    slants != nullptr ? hn::Load(d_, slants + place) : hn::Set(d_, 1.0f);
                const Vector aside =
                    hn::Add(hn::Mul(columns, scalar_per_column), hn::Mul(rows, scalar_per_row));
                writer.add(d_, place, {span, aside, slant}, inside);
            }
        }
    }

    // One number for each pixel of the blocks in a row or a column of blocks, counted from the
    // tile's first pixel.
    struct alignas(64) Pixels : std::array<float, TileGrid::edge * TileGrid::block> {};
    static constexpr Pixels block_columns = [] {
        Pixels columns{};
        for (int i = 0; i < TileGrid::edge * block; ++i)
            columns[static_cast<std::size_t>(i)] =
                static_cast<float>(i / (block * block) * block + i % block);
        return columns;
    }();
    static constexpr Pixels block_rows = [] {
        Pixels rows{};
        for (int i = 0; i < TileGrid::edge * block; ++i)
            rows[static_cast<std::size_t>(i)] = static_cast<float>(i / block);
        return rows;
    }();

    const TetFragments& fragments_;
    const TetTile& tile_;
    const TileGrid::Tile& area_;
    Tag d_;
    std::int64_t count_ = 0;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

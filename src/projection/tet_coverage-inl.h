// SPDX-License-Identifier: Apache-2.0
// Which pixels of a tile have rays that meet a part, and where.
#if defined(LAMINA_PROJECTION_TET_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#undef LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#else
#define LAMINA_PROJECTION_TET_COVERAGE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "projection/tet_run-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, TileGrid::block * TileGrid::block>;
using Vector = hn::Vec<Tag>;

// Vectors of 4 x 1, 4 x 2 or 4 x 4 pixels of a tile whose rays meet a part.
class CoveredPixels {
  public:
    // Of the first pixel of a vector: TileGrid::place(), column and row from the record's center.
    struct Place {
        int place;
        float column, row;
    };

    // Kept where `any`: no branch, which nothing could predict.
    HWY_INLINE void add(Tag d, const Place& place, const InsideSpan<Vector>& span, bool any) {
        places_[count_] = place;
        hn::Store(span.enter, d, enter_ + count_ * lanes);
        hn::Store(span.leave, d, leave_ + count_ * lanes);
        count_ += any ? 1 : 0;
    }
    std::size_t count() const { return count_; }
    const Place& at(std::size_t i) const { return places_[i]; }
    std::size_t place(std::size_t i) const { return static_cast<std::size_t>(places_[i].place); }
    HWY_INLINE InsideSpan<Vector> span(Tag d, std::size_t i) const {
        return {hn::Load(d, enter_ + i * lanes), hn::Load(d, leave_ + i * lanes)};
    }

  private:
    static constexpr std::size_t lanes = hn::MaxLanes(Tag()), most = TileGrid::pixels / lanes + 1;
    std::size_t count_ = 0;
    Place places_[most];
    HWY_ALIGN float enter_[most * lanes];
    HWY_ALIGN float leave_[most * lanes];
};

// The blocks of a tile that an area of the picture touches, a bit each, row by row.
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

// Calls visit(column, row) for the first pixels of blocks, in the tile.
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
    TetCoverage(const TetFragments& fragments, const TileGrid::Tile& area)
        : fragments_(fragments), area_(area) {
        const Vector number = hn::Iota(d_, 0.0f),
                     width = hn::Set(d_, static_cast<float>(TileGrid::block));
        lane_rows_ = hn::Floor(hn::Div(number, width));
        lane_columns_ = hn::Sub(number, hn::Mul(lane_rows_, width));
        const Vector a_row = hn::Set(d_, static_cast<float>(blocks_a_row)),
                     half = hn::Set(d_, 0.5f * (block - 1));
        const Vector row = hn::Floor(hn::Div(number, a_row));
        block_rows_ = hn::Add(hn::Mul(row, width), half);
        block_columns_ = hn::Add(hn::Mul(hn::Sub(number, hn::Mul(row, a_row)), width), half);
    }
    Vector columns(const CoveredPixels::Place& place) const {
        return hn::Add(lane_columns_, hn::Set(d_, place.column));
    }
    Vector rows(const CoveredPixels::Place& place) const {
        return hn::Sub(hn::Set(d_, place.row), lane_rows_);
    }

    // `cut`: between the part's planes of constant scalar.
    template <bool cut>
    HWY_INLINE void find(const TetRecord& record, const PartArea& area, CoveredPixels& covered) {
        const std::uint64_t blocks = blocks_of(area, area_);
        if (area.careful) {
            find_in<cut, true, CarefulDepths<Tag>>(record, area, blocks, covered);
            return;
        }
        const bool many = hwy::PopCount(blocks) > few_blocks;
        const std::uint64_t kept = many ? drop_missed(record, blocks) : blocks;
        // Blocks at the picture's right and lower edge may stick out of it.
        const bool whole_blocks = area_.width % block == 0 && area_.height % block == 0;
        if (area.bounded || !whole_blocks) {
            find_in<cut, true, PlainDepths<Tag>>(record, area, kept, covered);
        } else {
            find_in<cut, false, PlainDepths<Tag>>(record, area, kept, covered);
        }
    }
    std::int64_t fragments() const { return count_; }

  private:
    static constexpr std::size_t few_blocks = 6;  // are looked at one by one
    static constexpr int block = TileGrid::block, blocks_a_row = TileGrid::edge / TileGrid::block;

    float from_column(const TetRecord& record) const {
        return static_cast<float>(area_.column) + 0.5f - record.center[0];
    }
    float from_row(const TetRecord& record) const {
        return static_cast<float>(fragments_.image_rows - area_.row) - 0.5f - record.center[1];
    }

    // Blocks without those no ray of which can meet the tet: at a block's centre depths on faces
    // differ from those elsewhere in it by at most 1.5 pixels' worth.
    HWY_INLINE std::uint64_t drop_missed(const TetRecord& record, std::uint64_t blocks) const {
        constexpr std::size_t lanes = hn::MaxLanes(Tag());
        if constexpr (lanes < blocks_a_row) return blocks;
        // More than all roundings of the depths: what is dropped must not depend on the lanes.
        constexpr float rounding = 1e-6f;
        const float pixels_of_rounding =
            0.01f + rounding * (std::abs(from_column(record)) + std::abs(from_row(record)));
        const std::uint32_t fronts = record.fronts & 7u;
        const Vector columns = hn::Add(block_columns_, hn::Set(d_, from_column(record)));
        const auto start = [&](std::uint32_t face) HWY_ATTR {
            const float per_column = record.depth_per_column.high[face],
                        per_row = record.depth_per_row.high[face];
            const float reach = (0.5f * (block - 1) + pixels_of_rounding) *
                                    (std::abs(per_column) + std::abs(per_row)) +
                                rounding * std::abs(record.depth.high[face]);
            return at_column(d_, record.depth.high[face] + (face < fronts ? -reach : reach),
                             per_column, columns);
        };
        const Vector d0 = start(0), d1 = start(1), d2 = start(2), d3 = start(3);
        const auto& per_row = record.depth_per_row.high;
        std::uint64_t kept = 0;
        for (std::size_t first = 0; first < 64; first += lanes) {
            const std::uint64_t group = (~0ull >> (64 - lanes)) << first;
            if ((blocks & group) == 0) continue;
            const float row = from_row(record) - static_cast<float>(first / blocks_a_row * block);
            const Vector rows = hn::Sub(hn::Set(d_, row), block_rows_);
            const InsideSpan<Vector> span = order_depths(
                fronts, at_row(d_, d0, per_row[0], rows), at_row(d_, d1, per_row[1], rows),
                at_row(d_, d2, per_row[2], rows), at_row(d_, d3, per_row[3], rows));
            std::uint8_t bits[8];
            const std::size_t bytes = hn::StoreMaskBits(d_, hn::Gt(span.leave, span.enter), bits);
            for (std::size_t i = 0; i < bytes; ++i)
                kept |= (std::uint64_t{bits[i]} << (first + 8 * i)) & group;
        }
        return kept & blocks;
    }

    template <bool cut, bool bounded, class Depths>
    HWY_INLINE void find_in(const TetRecord& record, const PartArea& area, std::uint64_t blocks,
                            CoveredPixels& covered) {
        const int rows_a_vector = static_cast<int>(hn::Lanes(d_)) / block;
        const float first_column = from_column(record), first_row = from_row(record);
        const auto column_of = [&](int pixel) HWY_ATTR {
            return hn::Set(d_, first_column + static_cast<float>(pixel - area_.column));
        };
        const auto row_of = [&](int pixel) HWY_ATTR {
            return hn::Set(d_, first_row - static_cast<float>(pixel - area_.row));
        };
        const Vector first_in = column_of(area.first_column), last_in = column_of(area.last_column);
        const Vector highest = row_of(area.first_row), lowest = row_of(area.last_row);
        for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
            const int number = std::countr_zero(left);
            const float column = first_column + static_cast<float>(number % blocks_a_row * block);
            const float row_of_block =
                first_row - static_cast<float>(number / blocks_a_row * block);
            const Vector columns = hn::Add(lane_columns_, hn::Set(d_, column));
            const Depths depths(d_, fragments_, record, columns);
            for (int y = 0; y < block; y += rows_a_vector) {
                const float row = row_of_block - static_cast<float>(y);
                const Vector rows = hn::Sub(hn::Set(d_, row), lane_rows_);
                InsideSpan<Vector> span = depths.at(d_, rows);
                if constexpr (bounded) span.leave = hn::Min(span.leave, hn::Set(d_, area.farthest));
                if constexpr (cut) span = cut_depths(d_, record, span, columns, rows);
                auto inside = hn::Gt(span.leave, span.enter);
                if constexpr (bounded) {
                    const auto in_columns =
                        hn::And(hn::Ge(columns, first_in), hn::Le(columns, last_in));
                    const auto in_rows = hn::And(hn::Ge(rows, lowest), hn::Le(rows, highest));
                    inside = hn::And(inside, hn::And(in_columns, in_rows));
                }
                const std::size_t pixels = hn::CountTrue(d_, inside);
                count_ += static_cast<std::int64_t>(pixels);
                covered.add(d_, {number * block * block + y * block, column, row},
                            {hn::IfThenElseZero(inside, span.enter),
                             hn::IfThenElseZero(inside, span.leave)},
                            pixels > 0);
            }
        }
    }

    const TetFragments& fragments_;
    const TileGrid::Tile& area_;
    Tag d_;
    Vector lane_columns_, lane_rows_;    // of a vector, from its first pixel
    Vector block_columns_, block_rows_;  // centres of the first blocks, from the tile's first pixel
    std::int64_t count_ = 0;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

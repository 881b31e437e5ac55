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
    HWY_INLINE void add(Tag d, int place, Vector columns, Vector rows,
                        const InsideSpan<Vector>& span) {
        places_[count_] = place;
        hn::Store(columns, d, columns_ + count_ * lanes);
        hn::Store(rows, d, rows_ + count_ * lanes);
        hn::Store(span.enter, d, enter_ + count_ * lanes);
        hn::Store(span.leave, d, leave_ + count_ * lanes);
        ++count_;
    }
    std::size_t count() const { return count_; }
    std::size_t place(std::size_t i) const { return static_cast<std::size_t>(places_[i]); }
    HWY_INLINE Vector columns(Tag d, std::size_t i) const {
        return hn::Load(d, columns_ + i * lanes);
    }
    HWY_INLINE Vector rows(Tag d, std::size_t i) const { return hn::Load(d, rows_ + i * lanes); }
    HWY_INLINE InsideSpan<Vector> span(Tag d, std::size_t i) const {
        return {hn::Load(d, enter_ + i * lanes), hn::Load(d, leave_ + i * lanes)};
    }

  private:
    static constexpr std::size_t lanes = hn::MaxLanes(Tag()), most = TileGrid::pixels / lanes;
    std::size_t count_ = 0;
    int places_[most];
    HWY_ALIGN float columns_[TileGrid::pixels], rows_[TileGrid::pixels], enter_[TileGrid::pixels],
        leave_[TileGrid::pixels];
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
    }

    // `cut`: between the part's planes of constant scalar.
    template <bool cut>
    HWY_INLINE void find(const TetRecord& record, const PartArea& area, CoveredPixels& covered) {
        const std::uint64_t blocks = blocks_of(area, area_);
        if (area.careful) {
            find_in<cut, CarefulDepths<Tag>>(record, blocks, covered);
        } else {
            const bool many = hwy::PopCount(blocks) > few_blocks;
            find_in<cut, PlainDepths<Tag>>(record, many ? drop_missed(record, blocks) : blocks,
                                           covered);
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
        const Vector half = hn::Set(d_, 0.5f * (block - 1)),
                     edge = hn::Set(d_, static_cast<float>(block));
        std::uint64_t kept = 0;
        constexpr std::size_t lanes = hn::MaxLanes(Tag());
        for (std::size_t first = 0; first < 64; first += lanes) {
            const std::uint64_t group = (~0ull >> (64 - lanes)) << first;
            if ((blocks & group) == 0) continue;
            const Vector number = hn::Iota(d_, static_cast<float>(first)),
                         row_number = hn::Floor(hn::Mul(number, hn::Set(d_, 1.0f / blocks_a_row)));
            const Vector column_number =
                hn::Sub(number, hn::Mul(row_number, hn::Set(d_, static_cast<float>(blocks_a_row))));
            const Vector columns = hn::Add(hn::Set(d_, from_column(record)),
                                           hn::Add(hn::Mul(column_number, edge), half));
            const Vector rows =
                hn::Sub(hn::Set(d_, from_row(record)), hn::Add(hn::Mul(row_number, edge), half));
            const auto farthest = [&](std::size_t face, float sign) HWY_ATTR {
                const float per_column = record.depth_per_column.high[face],
                            per_row = record.depth_per_row.high[face];
                const float reach = sign * (0.5f * (block - 1) + 0.01f) *
                                    (std::abs(per_column) + std::abs(per_row));
                return hn::Add(
                    at_row(d_, at_column(d_, record.depth.high[face], per_column, columns), per_row,
                           rows),
                    hn::Set(d_, reach));
            };
            const std::uint32_t fronts = record.fronts & 7u;
            const auto sign = [&](std::uint32_t face) { return face < fronts ? -1.0f : 1.0f; };
            const InsideSpan<Vector> span =
                order_depths(fronts, farthest(0, sign(0)), farthest(1, sign(1)),
                             farthest(2, sign(2)), farthest(3, sign(3)));
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(d_, hn::Gt(span.leave, span.enter), bits);
            std::uint64_t met = 0;
            std::memcpy(&met, bits, sizeof(met));
            kept |= (met << first) & group;
        }
        return kept & blocks;
    }

    template <bool cut, class Depths>
    HWY_INLINE void find_in(const TetRecord& record, std::uint64_t blocks, CoveredPixels& covered) {
        const int rows_a_vector = static_cast<int>(hn::Lanes(d_)) / block;
        const float first_column = from_column(record), first_row = from_row(record);
        for_each_block(blocks, [&](int column, int row_of_block) HWY_ATTR {
            const Vector columns =
                hn::Add(lane_columns_, hn::Set(d_, first_column + static_cast<float>(column)));
            const Depths depths(d_, fragments_, record, columns);
            for (int row = row_of_block; row < row_of_block + block; row += rows_a_vector) {
                const Vector rows =
                    hn::Sub(hn::Set(d_, first_row - static_cast<float>(row)), lane_rows_);
                InsideSpan<Vector> span = depths.at(d_, rows);
                if constexpr (cut) span = cut_depths(d_, record, span, columns, rows);
                const auto inside = hn::Gt(span.leave, span.enter);
                if (hn::AllFalse(d_, inside)) continue;
                count_ += static_cast<std::int64_t>(hn::CountTrue(d_, inside));
                covered.add(d_, TileGrid::place(column, row), columns, rows,
                            {hn::IfThenElseZero(inside, span.enter),
                             hn::IfThenElseZero(inside, span.leave)});
            }
        });
    }

    const TetFragments& fragments_;
    const TileGrid::Tile& area_;
    Tag d_;
    Vector lane_columns_, lane_rows_;
    std::int64_t count_ = 0;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

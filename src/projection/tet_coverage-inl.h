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

#include "projection/fragment_queue-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
    TetCoverage(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile), area_(tile.area) {}

    // The blocks of the tile that a part may cover, a bit each, row by row.
    HWY_INLINE std::uint64_t blocks(const TetRecord& record, const PartArea& area) const {
        const std::uint64_t all = blocks_of(area, area_);
        return area.careful ? all : all & blocks_met(record);
    }

    // `cut`: between the part's planes of constant scalar.
    HWY_INLINE void find(bool cut, const TetRecord& record, const PartArea& area,
                         std::uint64_t blocks, std::size_t part, FragmentQueue& found) {
        // Blocks at the picture's right and lower edge may stick out of it.
        const bool whole_blocks = area_.width % block == 0 && area_.height % block == 0;
        FragmentQueue::Writer writer(found, part);
        if (area.careful) {
            find_in<true, CarefulDepths<Tag>>(cut, record, area, blocks, writer);
        } else if (area.bounded || !whole_blocks) {
            find_in<true, PlainDepths<Tag>>(cut, record, area, blocks, writer);
        } else {
            find_in<false, PlainDepths<Tag>>(cut, record, area, blocks, writer);
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

    // Bounds of columns of blocks that are linear in the row of blocks: `at_first` in the first
    // row, `per_row` more in each one below. Least and greatest columns, of at most four lines.
    struct Bounds {
        alignas(16) std::array<float, 4> at_first, per_row;
    };

    // The tile's blocks, a bit each, without those no ray of which can meet the tet. Rays meet it
    // where depths on all front faces are less than on all back faces: inside of three or four
    // lines, the tet's silhouette, on which two of them are equal.
    HWY_INLINE std::uint64_t blocks_met(const TetRecord& record) const {
        Bounds least, greatest;
        find_silhouette(record, least, greatest);
        const hn::CappedTag<float, blocks_a_row> d;
        const hn::RebindToSigned<decltype(d)> di;
        const hn::Rebind<std::uint8_t, decltype(d)> d8;
        const auto columns = hn::Set(d, static_cast<float>(blocks_a_row));
        std::uint8_t bits[blocks_a_row];
        for (std::size_t row = 0; row < blocks_a_row; row += hn::Lanes(d)) {
            const auto rows = hn::Iota(d, static_cast<float>(row));
            auto first = hn::Zero(d), end = columns;
            for (std::size_t i = 0; i < 4; ++i) {
                first = hn::Max(first,
                                at_row(d, hn::Set(d, least.at_first[i]), least.per_row[i], rows));
                end = hn::Min(
                    end, at_row(d, hn::Set(d, greatest.at_first[i]), greatest.per_row[i], rows));
            }
            // 2^end - 2^first has the bits from `first` up to `end`.
            const auto power = [&](auto column)
                                   HWY_ATTR { return power_of_two(d, hn::ConvertTo(di, column)); };
            const auto some = hn::Sub(power(hn::Max(hn::Floor(end), hn::Zero(d))),
                                      power(hn::Min(hn::Ceil(first), columns)));
            hn::StoreU(hn::DemoteTo(d8, hn::ConvertTo(di, hn::Max(some, hn::Zero(d)))), d8,
                       bits + row);
        }
        std::uint64_t met;
        std::memcpy(&met, bits, sizeof(met));
        return met;
    }

    // Differences of depth on a line are D + C x + R y at the block x columns and y rows away from
    // the tile's first one. The bounds hold for the block's nearest corner.
    HWY_INLINE void find_silhouette(const TetRecord& record, Bounds& least,
                                    Bounds& greatest) const {
        const hn::FixedTag<float, 4> d;
        const hn::RebindToSigned<decltype(d)> di;
        // Pairs of a front and a back face.
        alignas(16) static constexpr std::int32_t front_of[4][4] = {
            {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 1}, {0, 1, 2, 2}};
        alignas(16) static constexpr std::int32_t back_of[4][4] = {
            {0, 0, 0, 0}, {1, 2, 3, 3}, {2, 2, 3, 3}, {3, 3, 3, 3}};
        const std::uint32_t fronts = record.fronts & 3u;
        const auto front = hn::IndicesFromVec(d, hn::Load(di, front_of[fronts]));
        const auto back = hn::IndicesFromVec(d, hn::Load(di, back_of[fronts]));
        const auto depth = hn::Load(d, record.depth.high.data()),
                   per_column = hn::Load(d, record.depth_per_column.high.data()),
                   per_row = hn::Load(d, record.depth_per_row.high.data());
        const auto difference = [&](auto v) HWY_ATTR {
            return hn::Sub(hn::TableLookupLanes(v, back), hn::TableLookupLanes(v, front));
        };
        const float x = from_column(record) + 0.5f * (block - 1),
                    y = from_row(record) - 0.5f * (block - 1);
        // More than all roundings of the depths of both faces: what is dropped must not be seen.
        constexpr float rounding = 1e-6f;
        const auto rounding_of_face =
            hn::Add(hn::Mul(hn::Add(hn::Abs(per_column), hn::Abs(per_row)),
                            hn::Set(d, 1e-3f + rounding * (std::abs(x) + std::abs(y)))),
                    hn::Mul(hn::Abs(depth), hn::Set(d, rounding)));
        const auto slack = hn::Add(hn::TableLookupLanes(rounding_of_face, back),
                                   hn::TableLookupLanes(rounding_of_face, front));
        const auto c = difference(per_column), r = difference(per_row);
        const auto abs_r = hn::Abs(r);
        // Lines along rows are made a little oblique: less than the hundredth of a pixel.
        constexpr float oblique = 1e-4f;
        const auto steepness =
            hn::Max(hn::Max(hn::Abs(c), hn::Mul(abs_r, hn::Set(d, oblique))), hn::Set(d, 1e-30f));
        const auto reach = hn::Add(hn::Add(hn::Mul(hn::Set(d, 0.5f * (block - 1)), hn::Abs(c)),
                                           hn::Mul(hn::Set(d, 0.5f * (block - 1) + 0.01f), abs_r)),
                                   slack);
        const auto highest = hn::Add(hn::Add(hn::Add(difference(depth), hn::Mul(c, hn::Set(d, x))),
                                             hn::Mul(r, hn::Set(d, y))),
                                     reach);
        const auto is_least = hn::Ge(c, hn::Zero(d));
        const auto divisor = hn::IfThenElse(is_least, steepness, hn::Neg(steepness));
        const auto at_first = hn::Div(hn::Mul(highest, hn::Set(d, -1.0f / block)), divisor);
        const auto slope = hn::Div(r, divisor);
        hn::Store(hn::IfThenElse(is_least, at_first, hn::Set(d, -1.0f)), d, least.at_first.data());
        hn::Store(hn::IfThenElseZero(is_least, slope), d, least.per_row.data());
        const auto next = hn::Add(at_first, hn::Set(d, 1.0f));
        hn::Store(hn::IfThenElse(is_least, hn::Set(d, static_cast<float>(blocks_a_row)), next), d,
                  greatest.at_first.data());
        hn::Store(hn::IfThenZeroElse(is_least, slope), d, greatest.per_row.data());
    }

    template <bool bounded, class Depths>
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
                const Vector slant =
                    slants != nullptr ? hn::Load(d_, slants + place) : hn::Set(d_, 1.0f);
                const Vector aside =
                    hn::Add(hn::Mul(columns, scalar_per_column), hn::Mul(rows, scalar_per_row));
                writer.add(d_, place, {span, aside, slant}, inside);
            }
        }
    }

    // Of the pixels of the blocks of a row, and of a column, from the tile's first pixel.
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

// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/tile_fragments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "projection/tet_color-inl.h"
#include "tiles/random_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, TileGrid::block * TileGrid::block>;
using V = hn::Vec<D>;

// What decides how fragments are computed, once for all of a part.
template <SegmentSource source_of, bool perspective_view, bool has_color, PartDepth most_depth,
          bool plain_target>
struct Shading {
    static constexpr SegmentSource source = source_of;
    static constexpr bool perspective = perspective_view, colored = has_color;
    static constexpr PartDepth depth = most_depth;
    static constexpr bool float32 = plain_target;
};

// Vectors of 4 x 1, 4 x 2 or 4 x 4 pixels of a tile whose rays meet a part.
class CoveredPixels {
  public:
    HWY_INLINE void add(D d, int place, V columns, V rows, const DepthSpan<V>& span) {
        places_[count_] = place;
        hn::Store(columns, d, columns_ + count_ * lanes);
        hn::Store(rows, d, rows_ + count_ * lanes);
        hn::Store(span.enter, d, enter_ + count_ * lanes);
        hn::Store(span.leave, d, leave_ + count_ * lanes);
        ++count_;
    }
    std::size_t count() const { return count_; }
    std::size_t place(std::size_t i) const { return static_cast<std::size_t>(places_[i]); }
    HWY_INLINE V columns(D d, std::size_t i) const { return hn::Load(d, columns_ + i * lanes); }
    HWY_INLINE V rows(D d, std::size_t i) const { return hn::Load(d, rows_ + i * lanes); }
    HWY_INLINE DepthSpan<V> span(D d, std::size_t i) const {
        return {hn::Load(d, enter_ + i * lanes), hn::Load(d, leave_ + i * lanes)};
    }

  private:
    static constexpr std::size_t lanes = hn::MaxLanes(D()), most = TileGrid::pixels / lanes;
    std::size_t count_ = 0;
    int places_[most];
    HWY_ALIGN float columns_[TileGrid::pixels], rows_[TileGrid::pixels], enter_[TileGrid::pixels],
        leave_[TileGrid::pixels];
};

class TetDrawing {
  public:
    TetDrawing(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile) {
        const V number = hn::Iota(d_, 0.0f),
                width = hn::Set(d_, static_cast<float>(TileGrid::block));
        lane_rows_ = hn::Floor(hn::Div(number, width));
        lane_columns_ = hn::Sub(number, hn::Mul(lane_rows_, width));
    }

    template <class Shade>
    HWY_INLINE void draw(const TetRecord& record, const PartArea& area) {
        CoveredPixels covered;
        const std::uint64_t blocks = blocks_of(area);
        if (area.careful) {
            find_covered<Shade, CarefulDepths<D>>(record, blocks, covered);
        } else {
            const bool many = hwy::PopCount(blocks) > few_blocks;
            find_covered<Shade, PlainDepths<D>>(record, many ? drop_missed(record, blocks) : blocks,
                                                covered);
        }
        shade<Shade>(record, covered);
    }
    std::int64_t fragments() const { return count_; }

  private:
    static constexpr std::size_t few_blocks = 6;  // are looked at one by one
    static constexpr int block = TileGrid::block, blocks_a_row = TileGrid::edge / TileGrid::block;

    // Blocks of the tile that the part may touch, a bit each, row by row.
    std::uint64_t blocks_of(const PartArea& area) const {
        const auto in_tile = [](int pixel, int first) {
            return std::clamp(pixel - first, 0, TileGrid::edge - 1) / block;
        };
        const int first_column = in_tile(area.first_column, tile_.area.column),
                  last_column = in_tile(area.last_column, tile_.area.column);
        const int first_row = in_tile(area.first_row, tile_.area.row),
                  last_row = in_tile(area.last_row, tile_.area.row);
        const std::uint64_t columns =
            (0xffull >> (blocks_a_row - 1 - last_column)) & (0xffull << first_column);
        const std::uint64_t rows = (~0ull >> blocks_a_row * (blocks_a_row - 1 - last_row)) &
                                   (~0ull << blocks_a_row * first_row);
        return rows & (columns * 0x0101010101010101ull);
    }

    // The same without blocks that no ray of which can meet the tet: at a block's centre depths on
    // faces differ from those elsewhere in it by at most 1.5 pixels' worth.
    HWY_INLINE std::uint64_t drop_missed(const TetRecord& record, std::uint64_t blocks) const {
        const V half = hn::Set(d_, 0.5f * (block - 1)),
                edge = hn::Set(d_, static_cast<float>(block));
        std::uint64_t kept = 0;
        constexpr std::size_t lanes = hn::MaxLanes(D());
        for (std::size_t first = 0; first < 64; first += lanes) {
            const std::uint64_t group = (~0ull >> (64 - lanes)) << first;
            if ((blocks & group) == 0) continue;
            const V number = hn::Iota(d_, static_cast<float>(first)),
                    row_number = hn::Floor(hn::Mul(number, hn::Set(d_, 1.0f / blocks_a_row)));
            const V column_number =
                hn::Sub(number, hn::Mul(row_number, hn::Set(d_, static_cast<float>(blocks_a_row))));
            const V columns = hn::Add(hn::Set(d_, from_column(record)),
                                      hn::Add(hn::Mul(column_number, edge), half));
            const V rows =
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
            const DepthSpan<V> span =
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

    float from_column(const TetRecord& record) const {
        return static_cast<float>(tile_.area.column) + 0.5f - record.center[0];
    }
    float from_row(const TetRecord& record) const {
        return static_cast<float>(fragments_.image_rows - tile_.area.row) - 0.5f - record.center[1];
    }

    template <class Shade, class Depths>
    HWY_INLINE void find_covered(const TetRecord& record, std::uint64_t blocks,
                                 CoveredPixels& covered) {
        const int rows_a_vector = static_cast<int>(hn::Lanes(d_)) / block;
        const float first_column = from_column(record), first_row = from_row(record);
        for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
            const int number = std::countr_zero(left), column = number % blocks_a_row * block,
                      row_of_block = number / blocks_a_row * block;
            const V columns =
                hn::Add(lane_columns_, hn::Set(d_, first_column + static_cast<float>(column)));
            const Depths depths(d_, fragments_, record, columns);
            for (int row = row_of_block; row < row_of_block + block; row += rows_a_vector) {
                const V rows =
                    hn::Sub(hn::Set(d_, first_row - static_cast<float>(row)), lane_rows_);
                DepthSpan<V> span = depths.at(d_, rows);
                if constexpr (Shade::source == SegmentSource::parts)
                    span = cut_depths(d_, record, span, columns, rows);
                const auto inside = hn::Gt(span.leave, span.enter);
                if (hn::AllFalse(d_, inside)) continue;
                count_ += static_cast<std::int64_t>(hn::CountTrue(d_, inside));
                covered.add(d_, TileGrid::place(column, row), columns, rows,
                            {hn::IfThenElseZero(inside, span.enter),
                             hn::IfThenElseZero(inside, span.leave)});
            }
        }
    }

    // Two at a time: one alone is a long chain of operations that wait for one another.
    template <class Shade>
    HWY_INLINE void shade(const TetRecord& record, const CoveredPixels& covered) {
        std::size_t i = 0;
        for (; i + 2 <= covered.count(); i += 2) {
            const Fragment<V> first = color_of<Shade>(record, covered, i);
            const Fragment<V> second = color_of<Shade>(record, covered, i + 1);
            put<Shade>(first, covered.place(i));
            put<Shade>(second, covered.place(i + 1));
        }
        if (i < covered.count()) put<Shade>(color_of<Shade>(record, covered, i), covered.place(i));
    }

    template <class Shade>
    HWY_INLINE Fragment<V> color_of(const TetRecord& record, const CoveredPixels& covered,
                                    std::size_t i) const {
        const std::size_t place = covered.place(i);
        const V slant =
            tile_.slants != nullptr ? hn::Load(d_, tile_.slants + place) : hn::Set(d_, 1.0f);
        const auto run = find_run<Shade>(d_, fragments_, record, covered.span(d_, i),
                                         covered.columns(d_, i), covered.rows(d_, i), slant);
        if constexpr (Shade::source == SegmentSource::constant)
            return constant_color(d_, fragments_, run);
        return part_color<Shade>(d_, fragments_, record, run);
    }

    // A fragment without opacity leaves its pixel as it is, in all targets.
    template <class Shade>
    HWY_INLINE void put(const Fragment<V>& fragment, std::size_t place) {
        TilePixels& pixels = tile_.pixels;
        Pixels<V> there{
            hn::Load(d_, pixels.red.data() + place), hn::Load(d_, pixels.green.data() + place),
            hn::Load(d_, pixels.blue.data() + place), hn::Load(d_, pixels.alpha.data() + place)};
        if constexpr (Shade::float32) {
            blend(d_, TargetBlend{}, fragment, there);
        } else {
            blend(d_, fragments_.blend, fragment, there);
        }
        hn::Store(there.red, d_, pixels.red.data() + place);
        hn::Store(there.green, d_, pixels.green.data() + place);
        hn::Store(there.blue, d_, pixels.blue.data() + place);
        hn::Store(there.alpha, d_, pixels.alpha.data() + place);
    }

    const TetFragments& fragments_;
    const TetTile& tile_;
    D d_;
    V lane_columns_, lane_rows_;
    std::int64_t count_ = 0;
};

template <SegmentSource source, bool perspective, bool colored, bool float32>
std::int64_t draw_parts(const TetFragments& fragments, const TileChunk& chunk,
                        const TileChunk::Parts& parts, const TetTile& tile) {
    TetDrawing drawing(fragments, tile);
    for_each_part(parts, [&](std::size_t part) HWY_ATTR {
        const TetRecord& record = chunk.record(part);
        const PartArea& area = chunk.area(part);
        if (source == SegmentSource::parts && colored && area.depth == PartDepth::faint) {
            drawing.draw<Shading<source, perspective, colored, PartDepth::faint, float32>>(record,
                                                                                           area);
        } else if (source == SegmentSource::parts && colored && area.depth == PartDepth::thin) {
            drawing.draw<Shading<source, perspective, colored, PartDepth::thin, float32>>(record,
                                                                                          area);
        } else {
            drawing.draw<Shading<source, perspective, colored, PartDepth::any, float32>>(record,
                                                                                         area);
        }
    });
    return drawing.fragments();
}

std::int64_t draw_any(const TetFragments& fragments, const TileChunk& chunk,
                      const TileChunk::Parts& parts, const TetTile& tile) {
    if (fragments.source == SegmentSource::constant)
        return draw_parts<SegmentSource::constant, true, false, false>(fragments, chunk, parts,
                                                                       tile);
    return draw_parts<SegmentSource::parts, true, true, true>(fragments, chunk, parts, tile);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(draw_any);

std::int64_t draw_tets(const TetFragments& fragments, const TileChunk& chunk,
                       const TileChunk::Parts& parts, const TetTile& tile) {
    return HWY_DYNAMIC_DISPATCH(draw_any)(fragments, chunk, parts, tile);
}

}  // namespace lamina
#endif

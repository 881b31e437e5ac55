// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/tile_fragments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "projection/tet_color-inl.h"
#include "tiles/random_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, TileGrid::block * TileGrid::block>;
using V = hn::Vec<D>;

// Pixels of a vector: 4 x 1, 4 x 2 or 4 x 4.
struct Lanes {
    int column, row;  // of the first, in the picture
    V columns, rows;  // of all, from the first
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

    void draw(const TetRecord& record, const PartArea& area) {
        if (area.kind == FragmentKind::careful) {
            draw_blocks<CarefulDepths<D>>(record, area);
        } else {
            draw_blocks<PlainDepths<D>>(record, area);
        }
    }
    std::int64_t fragments() const { return count_; }

  private:
    static constexpr int block = TileGrid::block;

    template <class Depths>
    void draw_blocks(const TetRecord& record, const PartArea& area) {
        const TileGrid::Tile& tile = tile_.area;
        const int first_column = std::max(area.first_column - tile.column, 0) / block * block;
        const int last_column = std::min(area.last_column - tile.column, TileGrid::edge - 1);
        const int first_row = std::max(area.first_row - tile.row, 0) / block * block;
        const int last_row = std::min(area.last_row - tile.row, TileGrid::edge - 1);
        const int rows_a_vector = static_cast<int>(hn::Lanes(d_)) / block;
        const float from_column = static_cast<float>(tile.column) + 0.5f - record.center[0];
        const float from_row =
            static_cast<float>(fragments_.image_rows - tile.row) - 0.5f - record.center[1];
        for (int column = first_column; column <= last_column; column += block) {
            const V columns =
                hn::Add(lane_columns_, hn::Set(d_, from_column + static_cast<float>(column)));
            const Depths depths(d_, fragments_, record, columns);
            for (int row = first_row; row <= last_row; row += rows_a_vector) {
                const V rows = hn::Sub(hn::Set(d_, from_row - static_cast<float>(row)), lane_rows_);
                draw_pixels(record, area.kind, depths.at(d_, rows), {column, row, columns, rows});
            }
        }
    }

    void draw_pixels(const TetRecord& record, FragmentKind kind, DepthSpan<V> span,
                     const Lanes& lanes) {
        if (fragments_.source == SegmentSource::parts)
            span = cut_depths(d_, record, span, lanes.columns, lanes.rows);
        const auto covered = hn::Gt(span.leave, span.enter);
        if (hn::AllFalse(d_, covered)) return;
        count_ += static_cast<std::int64_t>(hn::CountTrue(d_, covered));
        span = {hn::IfThenElseZero(covered, span.enter), hn::IfThenElseZero(covered, span.leave)};
        const auto place = static_cast<std::size_t>(TileGrid::place(lanes.column, lanes.row));
        const V slant =
            tile_.slants != nullptr ? hn::Load(d_, tile_.slants + place) : hn::Set(d_, 1.0f);
        const auto run = find_run(d_, fragments_, record, span, lanes.columns, lanes.rows, slant);
        put(color_of(record, kind, run), place);
    }

    Fragment<V> color_of(const TetRecord& record, FragmentKind kind, const TetRun<V>& run) const {
        if (fragments_.source == SegmentSource::constant)
            return constant_color(d_, fragments_, run);
        return part_color(d_, fragments_, record, kind == FragmentKind::thin, run);
    }

    // A fragment without opacity leaves its pixel as it is, in all targets.
    void put(const Fragment<V>& fragment, std::size_t place) {
        TilePixels& pixels = tile_.pixels;
        Pixels<V> there{
            hn::Load(d_, pixels.red.data() + place), hn::Load(d_, pixels.green.data() + place),
            hn::Load(d_, pixels.blue.data() + place), hn::Load(d_, pixels.alpha.data() + place)};
        blend(d_, fragments_.blend, fragment, there);
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

std::int64_t draw_parts(const TetFragments& fragments, const TileChunk& chunk,
                        const TileChunk::Parts& parts, const TetTile& tile) {
    TetDrawing drawing(fragments, tile);
    for_each_part(parts, [&](std::size_t part)
                             HWY_ATTR { drawing.draw(chunk.record(part), chunk.area(part)); });
    return drawing.fragments();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(draw_parts);

std::int64_t draw_tets(const TetFragments& fragments, const TileChunk& chunk,
                       const TileChunk::Parts& parts, const TetTile& tile) {
    return HWY_DYNAMIC_DISPATCH(draw_parts)(fragments, chunk, parts, tile);
}

}  // namespace lamina
#endif

// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/tile_general_fragments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/analytic_segment-inl.h"
#include "projection/fragment_output-inl.h"
#include "projection/tet_color-inl.h"
#include "projection/tet_drawing-inl.h"
#include "slicing/tile_preintegration-inl.h"
#include "tiles/segment_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Fragment<Vector> table_color(Tag d, const TetFragments& fragments,
                                        const TetRun<Vector>& run) {
    const auto entry =
        integrate_segment(d, *fragments.table, fragments.inverse_first_length,
                          fragments.single_color, run.front, run.back, run.world_length);
    // A table of opacities may have one at length 0.
    const auto met = hn::Gt(run.world_length, hn::Zero(d));
    return {hn::IfThenElseZero(met, entry.color[0]), hn::IfThenElseZero(met, entry.color[1]),
            hn::IfThenElseZero(met, entry.color[2]), hn::IfThenElseZero(met, entry.value)};
}

HWY_INLINE Fragment<Vector> analytic_color(Tag d, const TetFragments& fragments,
                                           const TetRun<Vector>& run) {
    const AnalyticSum sum =
        integrate_analytic(*fragments.transfer, fragments.colored, clamp01(d, run.front),
                           clamp01(d, run.back), run.world_length);
    const Vector opacity = opacity_from_depth(d, sum.depth);
    if (!fragments.colored) return with_color(d, fragments.single_color, opacity);
    return {sum.color[0], sum.color[1], sum.color[2], opacity};
}

HWY_INLINE Fragment<Vector> cut_table_color(Tag d, const TetFragments& fragments,
                                            const TetRun<Vector>& run) {
    constexpr Lookup kind = Lookup::gather;
    const TileTransfer& transfer = *fragments.transfer;
    const Vector front = clamp01(d, run.front), back = clamp01(d, run.back);
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const auto node = [&](Vector scalar)
                          HWY_ATTR { return table_place<kind>(transfer, scalar).node; };
    const TableCell extremes =
        table_cell(nodes, node(hn::Min(front, back)), node(hn::Max(front, back)));
    const auto seen = hn::And(hn::Ne(table_extinction(*transfer.table, extremes), hn::Zero(d)),
                              hn::Gt(run.world_length, hn::Zero(d)));
    if (hn::AllFalse(d, seen)) return {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const RunSum sum =
        integrate_run<kind>(transfer, fragments.colored, front, back, run.world_length, seen);
    const Vector opacity = opacity_from_depth(d, sum.depth);
    if (!fragments.colored) return with_color(d, fragments.single_color, opacity);
    return {hn::Mul(sum.color[0], opacity), hn::Mul(sum.color[1], opacity),
            hn::Mul(sum.color[2], opacity), opacity};
}

// Everything is asked at each vector of pixels.
struct GeneralShading {
    SegmentSource source;
    bool cut, scalars, perspective, colored, random;
    PartDepth depth;

    GeneralShading(const TetFragments& fragments, PartDepth part_depth)
        : source(fragments.source),
          cut(source == SegmentSource::parts),
          scalars(source != SegmentSource::constant),
          perspective(fragments.perspective),
          colored(fragments.colored),
          random(is_random(fragments)),
          depth(part_depth) {}

    static bool is_random(const TetFragments& fragments) {
        switch (fragments.output) {
            case FragmentOutput::native:
                return false;
            case FragmentOutput::emulated:
                return fragments.blend.alpha_rounding == AlphaRounding::stochastic;
            default:
                return true;
        }
    }

    HWY_NOINLINE Fragment<Vector> color(Tag d, const TetFragments& fragments,
                                        const TetRecord& record, const TetRun<Vector>& run) const {
        switch (source) {
            case SegmentSource::constant:
                return constant_color(d, fragments, run);
            case SegmentSource::parts:
                return part_color(d, colored, depth, fragments, record, run);
            case SegmentSource::table:
                return table_color(d, fragments, run);
            case SegmentSource::analytic:
                return analytic_color(d, fragments, run);
            default:
                return cut_table_color(d, fragments, run);
        }
    }
    HWY_NOINLINE void put(Tag d, const TetFragments& fragments, const TetRecord& record,
                          const Fragment<Vector>& fragment, const TetTile& tile,
                          std::size_t place) const {
        const auto bits = random
                              ? random_of_fragments(d, fragments, tile.area, place, record.number)
                              : hn::Zero(hn::RebindToUnsigned<Tag>());
        Pixels<Vector> there = load_pixels(d, tile.pixels, place);
        put_fragment(d, fragments, fragment, bits, there);
        store_pixels(d, there, tile.pixels, place);
    }
};

std::int64_t draw_any(const TetFragments& fragments, const TileChunk& chunk,
                      const TileChunk::Parts& parts, const TetTile& tile) {
    TetDrawing drawing(fragments, tile);
    for_each_part(parts, [&](std::size_t part) HWY_ATTR {
        const PartArea& area = chunk.area(part);
        drawing.draw(GeneralShading(fragments, area.depth), chunk.record(part), area);
    });
    return drawing.fragments();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(draw_any);

std::int64_t draw_general_tets(const TetFragments& fragments, const TileChunk& chunk,
                               const TileChunk::Parts& parts, const TetTile& tile) {
    return HWY_DYNAMIC_DISPATCH(draw_any)(fragments, chunk, parts, tile);
}

}  // namespace lamina
#endif

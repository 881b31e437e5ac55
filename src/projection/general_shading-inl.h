// SPDX-License-Identifier: Apache-2.0
// Shades fragments with everything that a plan may ask for. The plan is looked at for each vector
// of pixels.
#if defined(LAMINA_PROJECTION_GENERAL_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#undef LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#else
#define LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#endif

#include <hwy/highway.h>

#include "base/unreachable.h"
#include "executors/tile_preintegration-inl.h"
#include "projection/analytic_segment-inl.h"
#include "projection/fragment_output-inl.h"
#include "projection/tet_color-inl.h"
#include "projection/tet_drawing-inl.h"
#include "tiles/segment_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Fragment<Vector> table_color(Tag d, const TetFragments& fragments,
                                        const TetRun<Vector>& run) {
    const auto entry =
        integrate_segment(d, *fragments.table, fragments.inverse_first_length,
                          fragments.single_color, run.front, run.back, run.world_length);
    // A table of opacities may have an opacity above 0 at length 0.
    const auto met = hn::Gt(run.world_length, hn::Zero(d));
    return {hn::IfThenElseZero(met, entry.color[0]), hn::IfThenElseZero(met, entry.color[1]),
            hn::IfThenElseZero(met, entry.color[2]), hn::IfThenElseZero(met, entry.value)};
}

HWY_INLINE Fragment<Vector> analytic_color(Tag d, const TetFragments& fragments,
                                           const TetRun<Vector>& run) {
    const AnalyticSum sum = integrate_analytic(*fragments.transfer, fragments.colored, run.front,
                                               run.back, run.world_length);
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

// The colour of segments that may leave the window: before it, within it and behind it, where the
// transfer function is constant, one behind the other. `color`: that of segments within [0, 1].
template <class Color>
HWY_INLINE Fragment<Vector> windowed_color(Tag d, const TetFragments& fragments,
                                           const TetRun<Vector>& run, const Color& color) {
    if (!fragments.windowed) return color(d, fragments, run);
    const Vector in = clamp01(d, run.front), out = clamp01(d, run.back);
    const auto changes = hn::Ne(in, out);
    const auto leaves = hn::And(changes, hn::Or(hn::Ne(in, run.front), hn::Ne(out, run.back)));
    if (hn::AllFalse(d, leaves)) return color(d, fragments, {in, out, run.world_length});
    const Vector per_scalar = hn::Div(run.world_length, hn::Abs(hn::Sub(run.back, run.front)));
    const auto length = [&](Vector from, Vector to) HWY_ATTR {
        return hn::IfThenElseZero(changes, hn::Mul(per_scalar, hn::Abs(hn::Sub(to, from))));
    };
    // Segments that stay within the window keep their lengths, whatever their neighbours do.
    const Vector within = hn::IfThenElse(leaves, length(in, out), run.world_length);
    Fragment<Vector> sum = color(d, fragments, {in, in, length(run.front, in)});
    const auto put_behind = [&](const Fragment<Vector>& next) HWY_ATTR {
        const Vector left = hn::Sub(hn::Set(d, 1.0f), sum.alpha);
        sum = {mul_add(left, next.red, sum.red), mul_add(left, next.green, sum.green),
               mul_add(left, next.blue, sum.blue), mul_add(left, next.alpha, sum.alpha)};
    };
    put_behind(color(d, fragments, {in, out, within}));
    put_behind(color(d, fragments, {out, out, length(out, run.back)}));
    return sum;
}

// The colour of segments whose ends are given by their scalars.
HWY_NOINLINE inline Fragment<Vector> segment_color(Tag d, const TetFragments& fragments,
                                                   const TetRun<Vector>& run) {
    switch (fragments.source) {
        case SegmentSource::constant:
            return constant_color(d, fragments, run);
        case SegmentSource::table:
            return windowed_color(d, fragments, run, table_color);
        case SegmentSource::analytic:
            return analytic_color(d, fragments, run);
        case SegmentSource::cut_table:
            return windowed_color(d, fragments, run, cut_table_color);
        case SegmentSource::parts:
        case SegmentSource::mean:
        case SegmentSource::vertices:
            break;  // the colour of these does not come from two scalars
    }
    unreachable_enum();
}

// Puts the fragments of the cell fragment or tet `number` over the pixels from `place` on.
HWY_NOINLINE inline void put_fragments(Tag d, const TetFragments& fragments, std::uint32_t number,
                                       const Fragment<Vector>& fragment, const TetTile& tile,
                                       std::size_t place) {
    const bool random = is_random(fragments.output, fragments.blend);
    const auto bits = random ? random_of_fragments(d, fragments, tile.area, place, number)
                             : hn::Zero(hn::RebindToUnsigned<Tag>());
    if (fragments.opacity_only) {
        float* const plane = tile.opacity->data() + place;
        hn::Store(put_opacity(d, fragments, fragment.alpha, bits, hn::Load(d, plane)), d, plane);
        return;
    }
    Pixels<Vector> there = load_pixels(d, *tile.pixels, place);
    put_fragment(d, fragments, fragment, bits, there);
    store_pixels(d, there, *tile.pixels, place);
}

struct GeneralShader {
    static constexpr bool lit = false;
    bool cut, scalars, perspective, opacity_only;

    explicit GeneralShader(const TetFragments& fragments)
        : cut(fragments.source == SegmentSource::parts),
          scalars(fragments.source != SegmentSource::constant),
          perspective(fragments.perspective),
          opacity_only(fragments.opacity_only) {}

    // Codes must equal those of OpenGL's programs. These have no special case for optical depths
    // below faint_depth, and none for depth where depths are found in double precision.
    static PartDepth depth_of(const TetFragments& fragments, const PartArea& area) {
        if (!is_fixed_point(fragments.blend.target)) return area.depth;
        if (area.careful) return PartDepth::any;
        return area.depth == PartDepth::faint ? PartDepth::thin : area.depth;
    }

    HWY_NOINLINE Fragment<Vector> color(Tag d, const TetFragments& fragments,
                                        const TetRecord& record, const PartArea& area,
                                        const TetRun<Vector>& run) const {
        if (!cut) return segment_color(d, fragments, run);
        return part_color(d, fragments.colored, depth_of(fragments, area), fragments, record, run);
    }
    HWY_INLINE void put(Tag d, const TetFragments& fragments, std::uint32_t number,
                        const Fragment<Vector>& fragment, const TetTile& tile,
                        std::size_t place) const {
        put_fragments(d, fragments, number, fragment, tile, place);
    }
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

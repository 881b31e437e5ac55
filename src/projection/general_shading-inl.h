// SPDX-License-Identifier: Apache-2.0
// Shades fragments with everything that a plan may ask for. The plan is read for each vector of
// pixels.
#if defined(LAMINA_PROJECTION_GENERAL_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#undef LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#else
#define LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#endif

#include "base/enum_words.h"
#include "executors/cpu_transfer-inl.h"
#include "projection/analytic_segment-inl.h"
#include "projection/fragment_output-inl.h"
#include "projection/tet_color-inl.h"
#include "projection/tet_drawing-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE Fragment table_color(const TetFragments& fragments, const TetRun& run) {
    const SegmentEntry entry =
        integrate_segment(*fragments.table, fragments.inverse_first_length, fragments.single_color,
                          run.front, run.back, run.world_length);
    // A table of opacities may have an opacity above 0 at length 0.
    const FloatMask met = run.world_length > 0;
    return {zero_unless(met, entry.color[0]), zero_unless(met, entry.color[1]),
            zero_unless(met, entry.color[2]), zero_unless(met, entry.value)};
}

LAMINA_INLINE Fragment analytic_color(const TetFragments& fragments, const TetRun& run) {
    const AnalyticSum sum = integrate_analytic(*fragments.transfer, fragments.colored, run.front,
                                               run.back, run.world_length);
    const Float opacity = opacity_from_depth(sum.depth);
    if (!fragments.colored) return with_color(fragments.single_color, opacity);
    return {sum.color[0], sum.color[1], sum.color[2], opacity};
}

LAMINA_INLINE Fragment cut_table_color(const TetFragments& fragments, const TetRun& run) {
    constexpr Lookup kind = Lookup::gather;
    const TileTransfer& transfer = *fragments.transfer;
    const Float front = clamp01(run.front), back = clamp01(run.back);
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const auto node = [&](Float scalar)
                          LAMINA_LAMBDA { return table_place<kind>(transfer, scalar).node; };
    const TableCell extremes = table_cell(nodes, node(min(front, back)), node(max(front, back)));
    const FloatMask seen =
        (table_extinction(*transfer.table, extremes) != 0) & (run.world_length > 0);
    if (none_of(seen)) return {0, 0, 0, 0};
    const RunSum sum =
        integrate_run<kind>(transfer, fragments.colored, front, back, run.world_length, seen);
    const Float opacity = opacity_from_depth(sum.depth);
    if (!fragments.colored) return with_color(fragments.single_color, opacity);
    return {sum.color[0] * opacity, sum.color[1] * opacity, sum.color[2] * opacity, opacity};
}

// Returns the colour of segments that may leave the window: of the pieces before it, within it and
// behind it, one behind the other; the transfer function is constant outside. `color`: that of
// segments within [0, 1].
template <class Color>
LAMINA_INLINE Fragment windowed_color(const TetFragments& fragments, const TetRun& run,
                                      const Color& color) {
    if (!fragments.windowed) return color(fragments, run);
    const Float in = clamp01(run.front), out = clamp01(run.back);
    const FloatMask changes = in != out;
    const FloatMask leaves = changes & ((in != run.front) | (out != run.back));
    if (none_of(leaves)) return color(fragments, {in, out, run.world_length});
    const Float per_scalar = run.world_length / abs(run.back - run.front);
    const auto length = [&](Float from, Float to) LAMINA_LAMBDA {
        return zero_unless(changes, per_scalar * abs(to - from));
    };
    // Segments that stay within the window keep their lengths, independent of their neighbours.
    const Float within = select(leaves, length(in, out), run.world_length);
    Fragment sum = color(fragments, {in, in, length(run.front, in)});
    const auto put_behind = [&](const Fragment& next) LAMINA_LAMBDA {
        const Float left = 1 - sum.alpha;
        sum = {left * next.red + sum.red, left * next.green + sum.green,
               left * next.blue + sum.blue, left * next.alpha + sum.alpha};
    };
    put_behind(color(fragments, {in, out, within}));
    put_behind(color(fragments, {out, out, length(out, run.back)}));
    return sum;
}

// Returns the colour of segments whose ends are given by their scalars.
LAMINA_NOINLINE inline Fragment segment_color(const TetFragments& fragments, const TetRun& run) {
    switch (fragments.source) {
        case SegmentSource::constant:
            return constant_color(fragments, run);
        case SegmentSource::table:
            return windowed_color(fragments, run, table_color);
        case SegmentSource::analytic:
            return analytic_color(fragments, run);
        case SegmentSource::cut_table:
            return windowed_color(fragments, run, cut_table_color);
        case SegmentSource::parts:
        case SegmentSource::mean:
        case SegmentSource::vertices:
            break;  // the colour of these does not come from two scalars
    }
    unreachable_enum();
}

// Puts the fragments of the cell fragment or tet `number` over the pixels from `place` on.
LAMINA_NOINLINE inline void put_fragments(const TetFragments& fragments, std::uint32_t number,
                                          const Fragment& fragment, const TetTile& tile,
                                          std::size_t place) {
    const bool random = is_random(fragments.output, fragments.blend);
    const Word bits = random ? random_of_fragments(fragments, tile.area, place, number) : Word(0);
    if (fragments.opacity_only) {
        float* const plane = tile.opacity->data() + place;
        store(put_opacity(fragments, fragment.alpha, bits, load<Float>(plane)), plane);
        return;
    }
    Pixels there = load_pixels(*tile.pixels, place);
    put_fragment(fragments, fragment, bits, there);
    store_pixels(there, *tile.pixels, place);
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
    // below faint_depth, and none at all if depths are found in double precision.
    static PartDepth depth_of(const TetFragments& fragments, const PartArea& area) {
        if (!is_fixed_point(fragments.blend.target)) return area.depth;
        if (area.careful) return PartDepth::any;
        return area.depth == PartDepth::faint ? PartDepth::thin : area.depth;
    }

    LAMINA_NOINLINE Fragment color(const TetFragments& fragments, const SilhouetteRecord& record,
                                   const PartArea& area, const TetRun& run) const {
        if (!cut) return segment_color(fragments, run);
        return part_color(fragments.colored, depth_of(fragments, area), fragments, record.fragment,
                          run);
    }
    LAMINA_INLINE void put(const TetFragments& fragments, std::uint32_t number,
                           const Fragment& fragment, const TetTile& tile, std::size_t place) const {
        put_fragments(fragments, number, fragment, tile, place);
    }
};

LAMINA_SIMD_END

#endif

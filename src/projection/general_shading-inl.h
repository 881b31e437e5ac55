// SPDX-License-Identifier: Apache-2.0
// Shades fragments with every source, output and target of plans, chosen for each vector of pixels.
#if defined(LAMINA_PROJECTION_GENERAL_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#undef LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#else
#define LAMINA_PROJECTION_GENERAL_SHADING_INL_H_
#endif

#include "base/enum_words.h"
#include "executors/cpu_transfer-inl.h"
#include "projection/tet_drawing-inl.h"
#include "tiles/segment_optics-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// Returns random bits for a cell fragment's pixels from `place` on; 0 if the output is not random.
LAMINA_INLINE Word random_of_fragments(const TetFragments& fragments, const TileGrid::Tile& area,
                                       std::size_t place, std::uint32_t number) {
    const bool stochastic = fragments.blend.alpha_rounding == AlphaRounding::stochastic;
    if (fragments.output == FragmentOutput::native ||
        (fragments.output == FragmentOutput::emulated && !stochastic))
        return Word(0);
    const TileGrid::Place first = TileGrid::pixel_at(static_cast<int>(place));
    return random_of_pixels(area.column + first.column, area.row + first.row, number,
                            fragments.seed);
}

// Dithers as in Kraus 2004, section 4.2, but with one random number for opacity and colour, because
// the blending unit rounds associated colours, too.
LAMINA_INLINE Float dithered(float largest, Float value, Float random) {
    const Float scaled = clamp01(value) * largest;
    const Float whole = floor(scaled);
    const FloatMask up = random < scaled - whole;
    return (whole + zero_unless(up, Float(1))) / largest;
}

// Returns 24 of the random bits as a number in [0, 1).
LAMINA_INLINE Float as_share(Word random) {
    return to_float(bits_as<Int>(shift_right<8>(random))) * 0x1p-24f;
}

LAMINA_INLINE void put_codes(const TargetBlend& target, const Fragment& fragment, Word random,
                             Pixels& there) {
    const FloatMask seen = fragment.alpha > 0;
    const auto code = [&](Float color) LAMINA_LAMBDA {
        return color_code(target, zero_unless(seen, color / fragment.alpha * above_half_codes));
    };
    const Float alpha = alpha_code(target, Float64(fragment.alpha), random);
    composite_codes(target,
                    Pixels{code(fragment.red), code(fragment.green), code(fragment.blue), alpha},
                    there);
}

LAMINA_INLINE void put_fragment(const TetFragments& fragments, const Fragment& fragment,
                                Word random, Pixels& there) {
    const TargetBlend& target = fragments.blend;
    switch (fragments.output) {
        case FragmentOutput::emulated:
            put_codes(target, fragment, random, there);
            break;
        case FragmentOutput::stochastic:
            composite_stochastic(target, fragment, random, there);
            break;
        case FragmentOutput::dithered: {
            const Float share = as_share(random);
            const auto code = [&](Float v)
                                  LAMINA_LAMBDA { return dithered(target.largest, v, share); };
            blend(target,
                  Fragment{code(fragment.red), code(fragment.green), code(fragment.blue),
                           code(fragment.alpha)},
                  there);
            break;
        }
        case FragmentOutput::native:
            blend(target, fragment, there);
            break;
    }
}

// Returns a pixel's opacity, `there`, with a fragment's opacity composited over it.
LAMINA_INLINE Float put_opacity(const TetFragments& fragments, Float opacity, Word random,
                                Float there) {
    const TargetBlend& target = fragments.blend;
    switch (fragments.output) {
        case FragmentOutput::emulated:
            composite_opacity(target, alpha_code(target, Float64(opacity), random), there);
            return there;
        case FragmentOutput::stochastic: {
            Pixels pixels{there, there, there, there};
            composite_stochastic(target, Fragment{opacity, opacity, opacity, opacity}, random,
                                 pixels);
            return pixels.alpha;
        }
        case FragmentOutput::dithered:
            blend_opacity(target, dithered(target.largest, opacity, as_share(random)), there);
            return there;
        case FragmentOutput::native:
            blend_opacity(target, opacity, there);
            return there;
    }
    unreachable_enum();
}

// The associated colour and the optical depth of a segment.
struct AnalyticSum {
    Float color[3];
    Float depth;
};

// The piece of a segment in one interval of the transfer function.
struct AnalyticPiece {
    const CpuTransfer& transfer;
    FloatMask counted;  // lanes that have such a piece; the depth of others is 0
    FloatMask last;     // it ends at the end of the segment
    Int interval;
    Float share, next_share;    // shares of the interval, at the front and back
    Float scalar, next_scalar;  // at the front and at the back
    Float p, q, depth;          // extinction at the front and at the back times the piece's length;
                                // optical depth

    LAMINA_INLINE Float near(std::size_t channel) const {
        return optics_at<Lookup::gather>(transfer, channel, interval, share);
    }
    LAMINA_INLINE Float far(std::size_t channel) const {
        return optics_at<Lookup::gather>(transfer, channel, interval, next_share);
    }
};

// The weights of an AnalyticPiece's ends in its colour. They add up to its opacity.
struct EndWeights {
    Float near, far;
};

// Calls visit(AnalyticPiece) for the pieces of segments, front to back. Scalars may lie outside [0,
// 1]; there the first and the last interval go on.
template <class Visit>
LAMINA_INLINE void for_each_analytic_piece(const CpuTransfer& transfer, Float front, Float back,
                                           Float world_length, const Visit& visit) {
    constexpr Lookup kind = Lookup::gather;
    Int interval = find_interval<kind>(transfer, clamp01(front));
    const Int last = find_interval<kind>(transfer, clamp01(back));
    const FloatMask rising = !(interval > last);
    const FloatMask one_piece = interval == last;
    // The share of an interval at which the ray leaves it.
    const Float end_share = zero_unless(rising, Float(1));
    const Int to_end = zero_unless(rising, Int(1));
    const Int step = to_end + to_end - 1;
    const Float per_scalar = world_length / abs(back - front);
    Int left = abs(last - interval);

    Float scalar = front, share = share_of_interval<kind>(transfer, interval, front);
    while (true) {
        const FloatMask counted = left > -1;
        if (none_of(counted)) return;
        // The segment goes on to the end of this interval.
        const FloatMask whole = left > 0;
        const Int end = min(interval + to_end, transfer.intervals - 1);
        const Float next_scalar = select(whole, look_up<kind>(transfer.left_end, end), back);
        const Float next_share =
            select(whole, end_share, share_of_interval<kind>(transfer, interval, back));
        const Float length =
            select(one_piece, world_length, per_scalar * abs(next_scalar - scalar));
        const Float p = optics_at<kind>(transfer, 3, interval, share) * length,
                    q = optics_at<kind>(transfer, 3, interval, next_share) * length;
        const Float depth = zero_unless(counted, 0.5f * p + 0.5f * q);
        visit(AnalyticPiece{transfer, counted, !whole, interval, share, next_share, scalar,
                            next_scalar, p, q, depth});
        scalar = next_scalar;
        share = 1 - end_share;
        interval += zero_unless(whole, step);
        left -= 1;
    }
}

LAMINA_INLINE EndWeights end_weights(const AnalyticPiece& piece, Float opacity) {
    const Float near = zero_unless(piece.counted, piece_front_weight(piece.p, piece.q));
    return {near, max(opacity - near, 0)};
}

// Returns colour (if `colored`) and optical depth of segments by exact integrals of their pieces.
LAMINA_INLINE AnalyticSum integrate_analytic(const CpuTransfer& transfer, bool colored, Float front,
                                             Float back, Float world_length) {
    Float transmittance(1);
    AnalyticSum sum{{0, 0, 0}, 0};
    const auto add = [&](const AnalyticPiece& piece) LAMINA_LAMBDA {
        sum.depth += piece.depth;
        if (!colored) return;
        const Float opacity = opacity_from_depth(piece.depth);
        const EndWeights weights = end_weights(piece, opacity);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Float shown =
                weights.near * piece.near(channel) + weights.far * piece.far(channel);
            sum.color[channel] += transmittance * shown;
        }
        transmittance *= 1 - opacity;
    };
    for_each_analytic_piece(transfer, front, back, world_length, add);
    return sum;
}

LAMINA_INLINE Fragment table_color(const TetFragments& fragments, const FragmentSegment& segment) {
    const SegmentEntry entry =
        integrate_segment(*fragments.table, fragments.inverse_first_length, fragments.single_color,
                          segment.front, segment.back, segment.world_length);
    // A table of opacities may have an opacity above 0 at length 0.
    const FloatMask met = segment.world_length > 0;
    return {zero_unless(met, entry.color[0]), zero_unless(met, entry.color[1]),
            zero_unless(met, entry.color[2]), zero_unless(met, entry.value)};
}

LAMINA_INLINE Fragment analytic_color(const TetFragments& fragments,
                                      const FragmentSegment& segment) {
    const AnalyticSum sum = integrate_analytic(*fragments.transfer, fragments.colored,
                                               segment.front, segment.back, segment.world_length);
    const Float opacity = opacity_from_depth(sum.depth);
    if (!fragments.colored) return with_color(fragments.single_color, opacity);
    return {sum.color[0], sum.color[1], sum.color[2], opacity};
}

LAMINA_INLINE Fragment cut_table_color(const TetFragments& fragments,
                                       const FragmentSegment& segment) {
    constexpr Lookup kind = Lookup::gather;
    const CpuTransfer& transfer = *fragments.transfer;
    const Float front = clamp01(segment.front), back = clamp01(segment.back);
    const auto nodes = static_cast<std::int32_t>(transfer.table->nodes.size());
    const auto node = [&](Float scalar)
                          LAMINA_LAMBDA { return table_place<kind>(transfer, scalar).node; };
    const TableCell extremes = table_cell(nodes, node(min(front, back)), node(max(front, back)));
    const FloatMask seen =
        (table_extinction(*transfer.table, extremes) != 0) & (segment.world_length > 0);
    if (none_of(seen)) return {0, 0, 0, 0};
    const RunSum sum =
        integrate_run<kind>(transfer, fragments.colored, front, back, segment.world_length, seen);
    const Float opacity = opacity_from_depth(sum.depth);
    if (!fragments.colored) return with_color(fragments.single_color, opacity);
    return {sum.color[0] * opacity, sum.color[1] * opacity, sum.color[2] * opacity, opacity};
}

// Returns the colour of segments whose scalars may leave the window [0, 1], outside which the
// transfer function is constant: the colour of the pieces before the window, within it and behind
// it, composited. `color`: the function that returns the colour of segments within [0, 1].
template <class Color>
LAMINA_INLINE Fragment windowed_color(const TetFragments& fragments, const FragmentSegment& segment,
                                      const Color& color) {
    if (!fragments.windowed) return color(fragments, segment);
    const Float in = clamp01(segment.front), out = clamp01(segment.back);
    const FloatMask changes = in != out;
    const FloatMask leaves = changes & ((in != segment.front) | (out != segment.back));
    if (none_of(leaves)) return color(fragments, {in, out, segment.world_length});
    const Float per_scalar = segment.world_length / abs(segment.back - segment.front);
    const auto length = [&](Float from, Float to) LAMINA_LAMBDA {
        return zero_unless(changes, per_scalar * abs(to - from));
    };
    // Segments that stay within the window keep their lengths, independent of their neighbours.
    const Float within = select(leaves, length(in, out), segment.world_length);
    Fragment sum = color(fragments, {in, in, length(segment.front, in)});
    const auto put_behind = [&](const Fragment& next) LAMINA_LAMBDA {
        const Float left = 1 - sum.alpha;
        sum = {left * next.red + sum.red, left * next.green + sum.green,
               left * next.blue + sum.blue, left * next.alpha + sum.alpha};
    };
    put_behind(color(fragments, {in, out, within}));
    put_behind(color(fragments, {out, out, length(out, segment.back)}));
    return sum;
}

// Returns the colour of segments whose ends are given by their scalars.
LAMINA_NOINLINE inline Fragment segment_color(const TetFragments& fragments,
                                              const FragmentSegment& segment) {
    switch (fragments.source) {
        case SegmentSource::constant:
            return constant_color(fragments, segment);
        case SegmentSource::table:
            return windowed_color(fragments, segment, table_color);
        case SegmentSource::analytic:
            return analytic_color(fragments, segment);
        case SegmentSource::cut_table:
            return windowed_color(fragments, segment, cut_table_color);
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
    const Word bits = random_of_fragments(fragments, tile.area, place, number);
    if (fragments.opacity_only) {
        float* const plane = tile.opacity->data() + place;
        store(put_opacity(fragments, fragment.alpha, bits, load<Float>(plane)), plane);
        return;
    }
    Pixels there = load_pixels(*tile.pixels, place);
    put_fragment(fragments, fragment, bits, there);
    store_pixels(there, *tile.pixels, place);
}

// A Shader (tet_drawing-inl.h) for all plans without light.
struct GeneralShader {
    static constexpr bool lit = false;
    bool cut, scalars, perspective, opacity_only;

    explicit GeneralShader(const TetFragments& fragments)
        : cut(fragments.source == SegmentSource::parts),
          scalars(fragments.source != SegmentSource::constant),
          perspective(fragments.perspective),
          opacity_only(fragments.opacity_only) {}

    // Returns the bound by which a cell fragment's colour is computed. For targets with codes it is
    // that of OpenGL's programs, so that codes are equal: they have no case for depths below
    // faint_depth, and none at all if depths on faces are found in double precision.
    static DepthBound depth_of(const TetFragments& fragments, const CoveredArea& area) {
        if (!is_fixed_point(fragments.blend.target)) return area.depth;
        if (area.careful) return DepthBound::any;
        return area.depth == DepthBound::faint ? DepthBound::thin : area.depth;
    }

    LAMINA_NOINLINE Fragment color(const TetFragments& fragments, const SilhouetteRecord& record,
                                   const CoveredArea& area, const FragmentSegment& segment) const {
        if (!cut) return segment_color(fragments, segment);
        return cell_fragment_color(fragments.colored, depth_of(fragments, area), fragments,
                                   record.fragment, segment);
    }
    LAMINA_INLINE void put(const TetFragments& fragments, std::uint32_t number,
                           const Fragment& fragment, const TetTile& tile, std::size_t place) const {
        put_fragments(fragments, number, fragment, tile, place);
    }
};

LAMINA_SIMD_END

#endif

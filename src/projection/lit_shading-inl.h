// SPDX-License-Identifier: Apache-2.0
// Shades lit fragments: light is added to the colours that they have without it.
#if defined(LAMINA_PROJECTION_LIT_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_LIT_SHADING_INL_H_
#undef LAMINA_PROJECTION_LIT_SHADING_INL_H_
#else
#define LAMINA_PROJECTION_LIT_SHADING_INL_H_
#endif

#include "projection/general_shading-inl.h"
#include "projection/light_along-inl.h"

LAMINA_SIMD_BEGIN

// Gradients, and the direction to the eye, along a segment from front to back.
struct GradientRun {
    Float front[3], back[3], to_eye[3];

    // Returns the segment between two of its places, 0 to 1.
    LAMINA_INLINE LitRun between(Float from, Float to, Float front_depth, Float back_depth) const {
        LitRun run;
        run.front_depth = front_depth;
        run.back_depth = back_depth;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Float turn = back[axis] - front[axis];
            run.gradient[axis] = front[axis] + from * turn;
            run.turn[axis] = (to - from) * turn;
            run.to_eye[axis] = to_eye[axis];
        }
        return run;
    }
};

// Colour and opacity of a piece of a segment on which both are linear from `near` to `far`, with
// light, as they reach the front of the segment.
struct LitEnds {
    Float near[3], far[3];
    Float unlit[3];
};

template <std::size_t channels>
LAMINA_INLINE void add_channels(const TetFragments& fragments, const LitRun& run, Float in_front,
                                FloatMask wanted, const LitEnds& piece, Float (&color)[3]) {
    const LightSums<channels> sums =
        LightAlong<channels>(*fragments.light, fragments.smallest_square, run)
            .sum(in_front, wanted);
    for (std::size_t c = 0; c < 3; ++c) {
        const Float sum = piece.unlit[c] + sums.added(c, piece.near[c], piece.far[c]);
        // Light only multiplies existing colour: rounding may leave less than 0.
        color[c] += max(sum, 0);
    }
}

LAMINA_INLINE void add_lit(const TetFragments& fragments, const LitRun& run, Float in_front,
                           FloatMask wanted, const LitEnds& piece, Float (&color)[3]) {
    if (fragments.light->gray) {
        add_channels<1>(fragments, run, in_front, wanted, piece, color);
    } else {
        add_channels<3>(fragments, run, in_front, wanted, piece, color);
    }
}

struct LitShader {
    static constexpr bool lit = true, scalars = true, opacity_only = false;
    const TetFragments& fragments;
    bool cut, perspective;

    explicit LitShader(const TetFragments& of)
        : fragments(of), cut(of.source == SegmentSource::parts), perspective(of.perspective) {}

    LAMINA_NOINLINE Fragment lit_color(const TileBatch& batch, std::size_t part,
                                       const PlacedRay& found) const {
        const SilhouetteRecord& record = batch.record(part);
        const SeenTet& seen = record.seen();
        const Float column = found.column, row = found.row;
        GradientRun gradient;
        const Float slant = find_eye(seen, column, row, gradient);
        const bool by_depth = fragments.slanted;
        const TetSpan ends =
            find_ends(*this, fragments, record, found.span, by_depth ? slant : Float(1));
        const Float aside = column * seen.scalar_per_column + row * seen.scalar_per_row;
        const TetRun run = has_exact_runs(fragments, batch.area(part))
                               ? find_exact_run(*this, fragments, record, found, by_depth)
                               : run_between(*this, record, ends, aside);
        find_gradients(batch.gradient(part), column, row, ends, gradient);
        return cut ? part_lit(batch, part, run, gradient) : analytic_lit(run, gradient);
    }
    LAMINA_INLINE void put(const TetFragments&, std::uint32_t number, const Fragment& fragment,
                           const TetTile& tile, std::size_t place) const {
        put_fragments(fragments, number, fragment, tile, place);
    }

  private:
    // Sets the direction to the eye; returns the length of the ray per unit of z.
    LAMINA_INLINE Float find_eye(const SeenTet& record, Float column, Float row,
                                 GradientRun& gradient) const {
        const auto& [right, up, forward] = fragments.axes;
        if (!perspective) {
            for (int axis = 0; axis < 3; ++axis) gradient.to_eye[axis] = Float(-forward[axis]);
            return Float(1);
        }
        const float pixel = fragments.pixel_size;
        const Float x = (column + (record.center[0] - fragments.image_middle.x)) * pixel,
                    y = (row + (record.center[1] - fragments.image_middle.y)) * pixel;
        const Float slant = sqrt(1 + (x * x + y * y));
        for (int axis = 0; axis < 3; ++axis) {
            const Float along = forward[axis] + x * right[axis] + y * up[axis];
            gradient.to_eye[axis] = (0 - along) / slant;
        }
        return slant;
    }

    LAMINA_INLINE static void find_gradients(const GradientRecord& record, Float column, Float row,
                                             const TetSpan& ends, GradientRun& gradient) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const GradientRecord::Component& of = record.components[axis];
            const Float aside = column * of.per_column + row * of.per_row;
            const auto at = [&](const TetSpanEnd& end) LAMINA_LAMBDA {
                const Float sum = of.at_center + end.from_center * of.per_z + end.z * aside;
                // It is nowhere longer than at the points, except for rounding in slivers.
                return clamp(sum, -1, 1);
            };
            gradient.front[axis] = at(ends.front);
            gradient.back[axis] = at(ends.back);
        }
    }

    LAMINA_INLINE Fragment part_lit(const TileBatch& batch, std::size_t part, const TetRun& run,
                                    const GradientRun& gradient) const {
        const FragmentRecord& record = batch.record(part).fragment;
        const Fragment unlit = part_color(
            true, GeneralShader::depth_of(fragments, batch.area(part)), fragments, record, run);
        const auto optics = [&](std::size_t i, Float place) LAMINA_LAMBDA {
            return mix(Float(record.low[i]), Float(record.high[i]), place);
        };
        LitEnds piece{{}, {}, {unlit.red, unlit.green, unlit.blue}};
        for (std::size_t c = 0; c < 3; ++c) {
            piece.near[c] = optics(c, run.front);
            piece.far[c] = optics(c, run.back);
        }
        const LitRun light_run = gradient.between(0, 1, optics(3, run.front) * run.world_length,
                                                  optics(3, run.back) * run.world_length);
        Float color[3] = {0, 0, 0};
        add_lit(fragments, light_run, 1, unlit.alpha > 0, piece, color);
        return {color[0], color[1], color[2], unlit.alpha};
    }

    LAMINA_INLINE Fragment analytic_lit(const TetRun& run, const GradientRun& gradient) const {
        Float color[3] = {0, 0, 0};
        const Float front = run.front, back = run.back;
        const Float per_scalar = 1 / abs(back - front);
        const auto place = [&](Float scalar)
                               LAMINA_LAMBDA { return abs(scalar - front) * per_scalar; };
        Float depth(0), transmittance(1), from(0);
        const auto add = [&](const AnalyticPiece& piece) LAMINA_LAMBDA {
            const Float opacity = opacity_from_depth(piece.depth);
            const EndWeights weights = end_weights(piece, opacity);
            const Float to = select(piece.last, Float(1), place(piece.next_scalar));
            LitEnds ends;
            for (std::size_t c = 0; c < 3; ++c) {
                ends.near[c] = piece.near(c);
                ends.far[c] = piece.far(c);
                const Float shown = weights.near * ends.near[c] + weights.far * ends.far[c];
                ends.unlit[c] = transmittance * shown;
            }
            const FloatMask wanted = piece.counted & (opacity > 0);
            add_lit(fragments, gradient.between(from, to, piece.p, piece.q), transmittance, wanted,
                    ends, color);
            depth += piece.depth;
            transmittance *= 1 - opacity;
            from = to;
        };
        for_each_analytic_piece(*fragments.transfer, front, back, run.world_length, add);
        return {color[0], color[1], color[2], opacity_from_depth(depth)};
    }
};

LAMINA_SIMD_END

#endif

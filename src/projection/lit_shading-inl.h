// SPDX-License-Identifier: Apache-2.0
// Shades lit fragments: light is added to the colours that they have without it.
#if defined(LAMINA_PROJECTION_LIT_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_LIT_SHADING_INL_H_
#undef LAMINA_PROJECTION_LIT_SHADING_INL_H_
#else
#define LAMINA_PROJECTION_LIT_SHADING_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/general_shading-inl.h"
#include "projection/light_along-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Gradients, and the direction to the eye, along a run from front to back.
struct GradientRun {
    Number front[3], back[3], to_eye[3];

    // Between two places of the run, 0 to 1.
    HWY_INLINE LitRun between(Number from, Number to, Number front_depth, Number back_depth) const {
        LitRun run;
        run.front_depth = front_depth;
        run.back_depth = back_depth;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Number turn = back[axis] - front[axis];
            run.gradient[axis] = front[axis] + from * turn;
            run.turn[axis] = (to - from) * turn;
            run.to_eye[axis] = to_eye[axis];
        }
        return run;
    }
};

// Colour and opacity of a piece of a run on which both are linear from `near` to `far`, with light:
// what of it reaches the front of the run.
struct LitEnds {
    Floats near[3], far[3];
    Floats unlit[3];
};

template <std::size_t channels>
HWY_INLINE void add_channels(const TetFragments& fragments, const LitRun& run, Number in_front,
                             FloatMask wanted, const LitEnds& piece, Floats (&color)[3]) {
    const LightSums<channels> sums =
        LightAlong<channels>(*fragments.light, fragments.smallest_square, run)
            .sum(in_front, wanted);
    for (std::size_t c = 0; c < 3; ++c) {
        const Number sum =
            Number(piece.unlit[c]) + sums.added(c, Number(piece.near[c]), Number(piece.far[c]));
        // Light only multiplies what is there: rounding may leave less than nothing.
        color[c] = hn::Add(color[c], max(sum, Number(0)).v);
    }
}

HWY_INLINE void add_lit(const TetFragments& fragments, const LitRun& run, Number in_front,
                        FloatMask wanted, const LitEnds& piece, Floats (&color)[3]) {
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

    HWY_NOINLINE Fragment<Vector> lit_color(const TileBatch& batch, std::size_t part,
                                            const FragmentQueue::Found& found) const {
        const Tag d;
        const TetRecord& record = batch.record(part);
        const Number column(found.aside), row(found.slant);
        GradientRun gradient;
        const Number slant = find_eye(record, column, row, gradient);
        const bool by_depth = fragments.slanted;
        const auto ends = find_ends(d, *this, fragments, record, found.span,
                                    by_depth ? slant.v : hn::Set(d, 1.0f));
        const Number aside =
            column * Number(record.scalar_per_column) + row * Number(record.scalar_per_row);
        const TetRun<Vector> run =
            has_exact_runs(fragments, batch.area(part))
                ? find_exact_run(d, *this, fragments, record, found.span, column.v, row.v, by_depth)
                : run_between(d, *this, record, ends, aside.v);
        find_gradients(batch.gradient(part), column, row, ends, gradient);
        return cut ? part_lit(batch, part, run, gradient) : analytic_lit(run, gradient);
    }
    HWY_INLINE void put(Tag d, const TetFragments&, std::uint32_t number,
                        const Fragment<Vector>& fragment, const TetTile& tile,
                        std::size_t place) const {
        put_fragments(d, fragments, number, fragment, tile, place);
    }

  private:
    // Sets the direction to the eye; returns the length of the ray per unit of z.
    HWY_INLINE Number find_eye(const TetRecord& record, Number column, Number row,
                               GradientRun& gradient) const {
        const auto& [right, up, forward] = fragments.axes;
        if (!perspective) {
            for (int axis = 0; axis < 3; ++axis) gradient.to_eye[axis] = Number(-forward[axis]);
            return Number(1);
        }
        const Number pixel(fragments.pixel_size);
        const Number x = (column + Number(record.center[0] - fragments.image_middle.x)) * pixel,
                     y = (row + Number(record.center[1] - fragments.image_middle.y)) * pixel;
        const Number slant = hn::Sqrt((Number(1) + (x * x + y * y)).v);
        for (int axis = 0; axis < 3; ++axis) {
            const Number along =
                Number(forward[axis]) + x * Number(right[axis]) + y * Number(up[axis]);
            gradient.to_eye[axis] = (Number(0) - along) / slant;
        }
        return slant;
    }

    HWY_INLINE static void find_gradients(const GradientRecord& record, Number column, Number row,
                                          const TetSpan<Vector>& ends, GradientRun& gradient) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const GradientRecord::Component& of = record.components[axis];
            const Number aside = column * Number(of.per_column) + row * Number(of.per_row);
            const auto at = [&](const TetSpanEnd<Vector>& end) HWY_ATTR {
                const Number sum = Number(of.at_center) +
                                   Number(end.from_center) * Number(of.per_z) +
                                   Number(end.z) * aside;
                // Nowhere longer than at the points, but for rounding in slivers.
                return min(max(sum, Number(-1)), Number(1));
            };
            gradient.front[axis] = at(ends.front);
            gradient.back[axis] = at(ends.back);
        }
    }

    HWY_INLINE Fragment<Vector> part_lit(const TileBatch& batch, std::size_t part,
                                         const TetRun<Vector>& run,
                                         const GradientRun& gradient) const {
        const Tag d;
        const TetRecord& record = batch.record(part);
        const Fragment<Vector> unlit = part_color(
            d, true, GeneralShader::depth_of(fragments, batch.area(part)), fragments, record, run);
        const auto optics = [&](std::size_t i, Vector place) HWY_ATTR {
            return mix(hn::Set(d, record.low[i]), hn::Set(d, record.high[i]), place);
        };
        LitEnds piece{{}, {}, {unlit.red, unlit.green, unlit.blue}};
        for (std::size_t c = 0; c < 3; ++c) {
            piece.near[c] = optics(c, run.front);
            piece.far[c] = optics(c, run.back);
        }
        const Number length(run.world_length);
        const LitRun light_run =
            gradient.between(Number(0), Number(1), Number(optics(3, run.front)) * length,
                             Number(optics(3, run.back)) * length);
        Floats color[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        add_lit(fragments, light_run, Number(1), hn::Gt(unlit.alpha, hn::Zero(d)), piece, color);
        return {color[0], color[1], color[2], unlit.alpha};
    }

    HWY_INLINE Fragment<Vector> analytic_lit(const TetRun<Vector>& run,
                                             const GradientRun& gradient) const {
        const Tag d;
        Floats color[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        const Floats front = run.front, back = run.back;
        const Number per_scalar = Number(1) / Number(hn::Abs(hn::Sub(back, front)));
        const auto place = [&](Floats scalar) HWY_ATTR {
            return Number(hn::Abs(hn::Sub(scalar, front))) * per_scalar;
        };
        Floats depth = hn::Zero(d), transmittance = hn::Set(d, 1.0f);
        Number from(0);
        const auto add = [&](const AnalyticPiece& piece) HWY_ATTR {
            const Floats opacity = opacity_from_depth(d, piece.depth);
            const EndWeights weights = end_weights(piece, opacity);
            const Number to = select(piece.last, Number(1), place(piece.next_scalar));
            LitEnds ends;
            for (std::size_t c = 0; c < 3; ++c) {
                ends.near[c] = piece.near(c);
                ends.far[c] = piece.far(c);
                const Floats shown =
                    hn::Add(hn::Mul(weights.near, ends.near[c]), hn::Mul(weights.far, ends.far[c]));
                ends.unlit[c] = hn::Mul(transmittance, shown);
            }
            const FloatMask wanted = hn::And(piece.counted, hn::Gt(opacity, hn::Zero(d)));
            add_lit(fragments, gradient.between(from, to, Number(piece.p), Number(piece.q)),
                    Number(transmittance), wanted, ends, color);
            depth = hn::Add(depth, piece.depth);
            transmittance = hn::Mul(transmittance, hn::Sub(hn::Set(d, 1.0f), opacity));
            from = to;
        };
        for_each_analytic_piece(*fragments.transfer, front, back, run.world_length, add);
        return {color[0], color[1], color[2], opacity_from_depth(d, depth)};
    }
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

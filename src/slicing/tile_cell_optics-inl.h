// SPDX-License-Identifier: Apache-2.0
// Emission and absorption where the scalar is a cubic and the transfer function one linear piece
// (docs/numerics.md, section 9).
#if defined(LAMINA_SLICING_TILE_CELL_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CELL_OPTICS_INL_H_
#undef LAMINA_SLICING_TILE_CELL_OPTICS_INL_H_
#else
#define LAMINA_SLICING_TILE_CELL_OPTICS_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_optics-inl.h"
#include "slicing/tile_cubic-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Parts of larger optical depth are split: up to here seen_share() is good to .01 / 255.
inline constexpr float largest_part_depth = 0.75f;

// One interval of the transfer function for each lane. Colour and extinction are linear in the
// share, which is 0 at the left end and 1 at the right.
template <Lookup kind>
struct IntervalLanes {
    const TileTransfer& transfer;
    Ints number;

    HWY_INLINE Number left_end() const { return look_up<kind>(transfer.end, number); }
    // Beyond all scalars for the last interval.
    HWY_INLINE Number right_end() const {
        const FloatTag d;
        const IntTag di;
        const Floats beyond = hn::Set(d, 3e38f);
        if constexpr (kind == Lookup::one) return beyond;
        const float* const ends = transfer.end.data() + 1;
        Floats end = beyond;
        if constexpr (kind == Lookup::permute) {
            end = hn::TableLookupLanes(hn::LoadU(d, ends), hn::IndicesFromVec(d, number));
        } else {
            end = hn::GatherIndex(d, ends, number);
        }
        const auto last = hn::Eq(number, hn::Set(di, transfer.intervals - 1));
        return hn::IfThenElse(hn::RebindMask(d, last), beyond, end);
    }
    HWY_INLINE Number inverse_width() const {
        return look_up<kind>(transfer.inverse_width, number);
    }
    HWY_INLINE Number left(std::size_t channel) const {
        return look_up<kind>(transfer.left[channel], number);
    }
    HWY_INLINE Number change(std::size_t channel) const {
        return look_up<kind>(transfer.change[channel], number);
    }
    // A colour at a share, both times `opacity`.
    HWY_INLINE Number color(std::size_t channel, Number opacity, Number share) const {
        return left(channel) * opacity + change(channel) * share;
    }
    // The share as a cubic, for scalars of this interval.
    HWY_INLINE CubicLanes share_along(const CubicLanes& scalar) const {
        const Number inverse = inverse_width();
        return {{(scalar.c[0] - left_end()) * inverse, scalar.c[1] * inverse, scalar.c[2] * inverse,
                 scalar.c[3] * inverse}};
    }
};

// A part of a ray in one interval: its share, and extinction times the part's length at share 0 and
// its change to share 1.
struct LinearPart {
    CubicLanes share;
    Number extinction, change;

    // Exact: the extinction is a cubic.
    HWY_INLINE Number depth() const { return max(extinction + change * share.mean(), Number(0)); }
};

// 1 - exp(-depth) for depths up to largest_part_depth, with a relative error of 2e-5: interpolated
// at Chebyshev's nodes.
HWY_INLINE Number shallow_opacity(Number depth) {
    return depth * Number(polynomial(FloatTag(), depth.v,
                                     {0.99998385f, -0.49930894f, 0.16195904f, -0.031068699f}));
}

// Gauss' rule on 0 .. 1.
template <std::size_t points>
struct GaussRule;
template <>
struct GaussRule<3> {
    static constexpr float nodes[] = {0.11270167f, 0.5f, 0.88729833f};
    static constexpr float weights[] = {0.27777778f, 0.44444444f, 0.27777778f};
};
template <>
struct GaussRule<4> {
    static constexpr float nodes[] = {0.069431844f, 0.33000948f, 0.66999052f, 0.93056816f};
    static constexpr float weights[] = {0.17392742f, 0.32607258f, 0.32607258f, 0.17392742f};
};

// The share that reaches a part's front: the integral of share times emission times transmittance,
// for `opacity` of `depth`, which is at most largest_part_depth. Integrated by parts, so that only
// the share's slope is left for Gauss' rule (docs/numerics.md, section 9), and a constant share is
// exact.
template <std::size_t points>
HWY_INLINE Number seen_share(const LinearPart& part, Number depth, Number opacity) {
    using Rule = GaussRule<points>;
    const CubicLanes& share = part.share;
    // The optical depth up to t is t (d[0] + t (d[1] + t (d[2] + t d[3]))).
    const Number d[4] = {part.extinction + part.change * share.c[0],
                         part.change * (Number(1 / 2.0f) * share.c[1]),
                         part.change * (Number(1 / 3.0f) * share.c[2]),
                         part.change * (Number(1 / 4.0f) * share.c[3])};
    const Number all = shallow_opacity(depth);
    Number sum = opacity * share.c[0];
    for (std::size_t i = 0; i < points; ++i) {
        constexpr auto& nodes = Rule::nodes;
        const Number t(nodes[i]);
        const Number before = t * (d[0] + t * (d[1] + t * (d[2] + t * d[3])));
        const float weight = Rule::weights[i];
        const Number slope = Number(weight) * share.c[1] +
                             Number(2 * weight * nodes[i]) * share.c[2] +
                             Number(3 * weight * nodes[i] * nodes[i]) * share.c[3];
        sum = sum + slope * (all - shallow_opacity(before));
    }
    return min(max(sum, Number(0)), opacity);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

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

// Parts of larger optical depth are split: up to here mean_share() is good to .01 / 255.
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
    HWY_INLINE Number at(std::size_t channel, Number share) const {
        return optics_at<kind>(transfer, channel, number, share.v);
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

// exp(-depth) for depths up to largest_part_depth, good to 5e-6 (which weights of a mean forgive):
// interpolated at Chebyshev's nodes.
HWY_INLINE Number transmittance_of(Number depth) {
    return polynomial(FloatTag(), depth.v,
                      {0.99999716f, -0.99981007f, 0.49794633f, -0.15876627f, 0.02880527f});
}

// The mean of the share, weighted by what reaches the part's front: emission times transmittance.
// Gauss' rule with four points. Weights and weighted shares have the same nodes, so that the mean
// of a constant is exact.
HWY_INLINE Number mean_share(const LinearPart& part) {
    constexpr float nodes[] = {0.069431844f, 0.33000948f, 0.66999052f, 0.93056816f};
    constexpr float weights[] = {0.17392742f, 0.32607258f, 0.32607258f, 0.17392742f};
    const CubicLanes& share = part.share;
    // The optical depth up to t is t (d[0] + t (d[1] + t (d[2] + t d[3]))).
    const Number d[4] = {part.extinction + part.change * share.c[0],
                         part.change * (Number(1 / 2.0f) * share.c[1]),
                         part.change * (Number(1 / 3.0f) * share.c[2]),
                         part.change * (Number(1 / 4.0f) * share.c[3])};
    Number sum(0), weighted(0);
    for (std::size_t i = 0; i < 4; ++i) {
        const Number t(nodes[i]);
        const Number there = share.at(t);
        const Number extinction = part.extinction + part.change * there;
        const Number before = t * (d[0] + t * (d[1] + t * (d[2] + t * d[3])));
        const Number weight = Number(weights[i]) * extinction * transmittance_of(before);
        sum = sum + weight;
        weighted = weighted + weight * there;
    }
    const Number mean = weighted / max(sum, Number(1e-37f));
    return min(max(mean, Number(0)), Number(1));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

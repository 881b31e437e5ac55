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

#include <cstring>

#include "executors/tile_optics-inl.h"
#include "executors/tile_shallow-inl.h"
#include "slicing/tile_cubic-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// One interval of the transfer function for each lane. Colour and extinction are linear in the
// share, which is 0 at the left end and 1 at the right.
struct IntervalLanes {
    Number left_end, right_end;  // the right end of the last interval lies beyond all scalars
    Number inverse_width;
    Number left[4], change[4];  // colour and extinction

    // A colour at a share, both times `opacity`.
    HWY_INLINE Number color(std::size_t channel, Number opacity, Number share) const {
        return left[channel] * opacity + change[channel] * share;
    }
    // The share as a cubic, for scalars of this interval.
    HWY_INLINE CubicLanes share_along(const CubicLanes& scalar) const {
        return {{(scalar.c[0] - left_end) * inverse_width, scalar.c[1] * inverse_width,
                 scalar.c[2] * inverse_width, scalar.c[3] * inverse_width}};
    }
};

template <Lookup kind>
HWY_INLINE IntervalLanes interval_lanes(const TileTransfer& transfer, Ints number) {
    IntervalLanes lanes;
    lanes.left_end = look_up<kind>(transfer.end, number);
    lanes.right_end = look_up<kind>(transfer.right_end, number);
    lanes.inverse_width = look_up<kind>(transfer.inverse_width, number);
    for (std::size_t channel = 0; channel < 4; ++channel) {
        lanes.left[channel] = look_up<kind>(transfer.left[channel], number);
        lanes.change[channel] = look_up<kind>(transfer.change[channel], number);
    }
    return lanes;
}

// Records are fetched one by one and transposed, which is faster than a gather for each number.
template <>
HWY_INLINE IntervalLanes interval_lanes<Lookup::gather>(const TileTransfer& transfer, Ints number) {
    const FloatTag d;
    constexpr std::size_t parts = 3, size = 4;
    alignas(64) std::int32_t numbers[most_lanes];
    alignas(64) float records[parts][size * most_lanes];
    hn::Store(number, IntTag(), numbers);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
        const float* const from =
            transfer.records.data() +
            TileTransfer::record_size * static_cast<std::size_t>(numbers[lane]);
        for (std::size_t part = 0; part < parts; ++part)
            std::memcpy(records[part] + size * lane, from + size * part, size * sizeof(float));
    }
    IntervalLanes lanes;
    Floats unused;
    hn::LoadInterleaved4(d, records[0], lanes.left[3].v, lanes.change[3].v, lanes.left_end.v,
                         lanes.right_end.v);
    hn::LoadInterleaved4(d, records[1], lanes.inverse_width.v, lanes.left[0].v, lanes.left[1].v,
                         lanes.left[2].v);
    hn::LoadInterleaved4(d, records[2], lanes.change[0].v, lanes.change[1].v, lanes.change[2].v,
                         unused);
    return lanes;
}

// A part of a ray in one interval: its share, and extinction times the part's length at share 0 and
// its change to share 1.
struct LinearPart {
    CubicLanes share;
    Number extinction, change;

    // Exact: the extinction is a cubic. In an interval whose extinction changes, the share is one;
    // beside samples far outside the range it may be less exact than that.
    HWY_INLINE Number depth() const {
        const Number mean = min(max(share.mean(), Number(0)), Number(1));
        return max(extinction + change * mean, Number(0));
    }
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

// SPDX-License-Identifier: Apache-2.0
// Emission and absorption of a piece, on which the scalar is a cubic and the transfer function one
// interval (docs/numerics.md, section 9.2; numbers in brackets are equations there).
//
//   q(t)     = the place in the interval, 0 .. 1: the scalar's cubic, scaled
//   depth    = length (a + b mean of q)                                              (9.2)
//   opacity  = 1 - exp(-depth)
//   Q        = q(0) opacity + int q'(t) (exp(-D(t)) - exp(-D(1))) dt, by Gauss' rule (9.4)
//   color    = c0 opacity + (c1 - c0) Q                                              (9.3)
//
// A curved interval's extinction is a cubic of q instead of a + b q; depth is its mean.
#if defined(LAMINA_SLICING_CPU_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_OPTICS_INL_H_
#undef LAMINA_SLICING_CPU_OPTICS_INL_H_
#else
#define LAMINA_SLICING_CPU_OPTICS_INL_H_
#endif

#include <cstring>

#include "executors/tile_optics-inl.h"
#include "executors/tile_shallow-inl.h"
#include "slicing/cpu_cubic-inl.h"
#include "tiles/opacity-inl.h"

LAMINA_SIMD_BEGIN

// The bends of an interval (TileTransfer::bend).
template <bool curved>
struct IntervalBend {};
template <>
struct IntervalBend<true> {
    Float bend[2];
};

// One interval of the transfer function for each lane. Colour is linear in the share, which is 0 at
// the left end and 1 at the right. Extinction is linear, too, or a curve.
template <bool curved>
struct IntervalLanes : IntervalBend<curved> {
    Float left_end, right_end;  // the right end of the last interval lies beyond all scalars
    Float inverse_width;
    Float left[4], change[4];  // colour and extinction

    // Returns the associated colour (9.3). `seen`: Q of (9.4).
    LAMINA_INLINE Float color(std::size_t channel, Float opacity, Float seen) const {
        return left[channel] * opacity + change[channel] * seen;
    }
    // Returns the share as a cubic, for scalars of this interval.
    LAMINA_INLINE CubicLanes share_along(const CubicLanes& scalar) const {
        return {{(scalar.c[0] - left_end) * inverse_width, scalar.c[1] * inverse_width,
                 scalar.c[2] * inverse_width, scalar.c[3] * inverse_width}};
    }
};

// Records are fetched one by one and transposed, which is faster than a gather for each number.
template <bool curved>
LAMINA_INLINE IntervalLanes<curved> fetched_intervals(const TileTransfer& transfer, Int number) {
    constexpr std::size_t groups = curved ? 4 : 3, size = 4;
    alignas(64) std::int32_t numbers[most_lanes];
    alignas(64) float records[groups][size * most_lanes];
    store(number, numbers);
    for (std::size_t lane = 0; lane < Float::lanes; ++lane) {
        const float* const from =
            transfer.records.data() +
            TileTransfer::record_size * static_cast<std::size_t>(numbers[lane]);
        for (std::size_t group = 0; group < groups; ++group)
            std::memcpy(records[group] + size * lane, from + size * group, size * sizeof(float));
    }
    IntervalLanes<curved> lanes;
    Float unused;
    load_interleaved(records[0], lanes.left[3], lanes.change[3], lanes.left_end, lanes.right_end);
    load_interleaved(records[1], lanes.inverse_width, lanes.left[0], lanes.left[1], lanes.left[2]);
    Float bend[2];
    load_interleaved(records[2], lanes.change[0], lanes.change[1], lanes.change[2], bend[0]);
    if constexpr (curved) {
        load_interleaved(records[3], bend[1], unused, unused, unused);
        for (std::size_t i = 0; i < 2; ++i) lanes.bend[i] = bend[i];
    }
    return lanes;
}

template <Lookup kind, bool curved>
LAMINA_INLINE IntervalLanes<curved> interval_lanes(const TileTransfer& transfer, Int number) {
    if constexpr (kind == Lookup::gather) return fetched_intervals<curved>(transfer, number);
    IntervalLanes<curved> lanes;
    lanes.left_end = look_up<kind>(transfer.left_end, number);
    lanes.right_end = look_up<kind>(transfer.right_end, number);
    lanes.inverse_width = look_up<kind>(transfer.inverse_width, number);
    for (std::size_t channel = 0; channel < 4; ++channel) {
        lanes.left[channel] = look_up<kind>(transfer.left[channel], number);
        lanes.change[channel] = look_up<kind>(transfer.change[channel], number);
    }
    if constexpr (curved) {
        for (std::size_t i = 0; i < 2; ++i) lanes.bend[i] = look_up<kind>(transfer.bend[i], number);
    }
    return lanes;
}

// A piece: its place in the interval along it, and its extinction times its length.
template <bool curved>
struct PieceOptics;

// A straight interval: extinction at share 0, and its change to share 1.
template <>
struct PieceOptics<false> {
    CubicLanes share;
    Float extinction, change;

    PieceOptics() = default;
    LAMINA_INLINE PieceOptics(const IntervalLanes<false>& interval, const CubicLanes& piece_share,
                              Float length)
        : share(piece_share),
          extinction(interval.left[3] * length),
          change(interval.change[3] * length) {}

    // Returns the depth, exactly: the place is a cubic that stays in 0 .. 1 if the extinction
    // changes. The clamp guards against samples far outside the range, next to which it is less
    // exact.
    LAMINA_INLINE Float depth() const {
        const Float mean = clamp01(share.mean());
        return max(extinction + change * mean, 0);
    }
    // Returns the cubic whose value at t, times t, is the optical depth up to t.
    LAMINA_INLINE CubicLanes mean_depth() const {
        return {{extinction + change * share.c[0], change * ((1 / 2.0f) * share.c[1]),
                 change * ((1 / 3.0f) * share.c[2]), change * ((1 / 4.0f) * share.c[3])}};
    }
    // Returns the extinction at t, at which the place is `there`.
    LAMINA_INLINE Float extinction_at(Float, Float there) const {
        return max(extinction + change * there, 0);
    }
};

// A curved interval. The extinction is the cubic that has its values at four nodes of Gauss' rule,
// so that the optical depth is right if the extinction along the piece is a polynomial of degree 7.
template <>
struct PieceOptics<true> {
    CubicLanes share;
    CubicLanes extinction;

    PieceOptics() = default;
    LAMINA_INLINE PieceOptics(const IntervalLanes<true>& interval, const CubicLanes& piece_share,
                              Float length)
        : share(piece_share) {
        for (Float& c : extinction.c) c = Float(0);
        for (std::size_t i = 0; i < 4; ++i) {
            const Float u = clamp01(share.at(GaussRule<4>::nodes[i]));
            const Float bend = interval.bend[0] + u * interval.bend[1];
            const Float there = interval.left[3] + u * (interval.change[3] + (1 - u) * bend);
            const Float amount = max(there, 0) * length;
            for (std::size_t power = 0; power < 4; ++power)
                extinction.c[power] += through_nodes[power][i] * amount;
        }
    }

    LAMINA_INLINE Float depth() const { return max(extinction.mean(), 0); }
    LAMINA_INLINE CubicLanes mean_depth() const {
        return {{extinction.c[0], (1 / 2.0f) * extinction.c[1], (1 / 3.0f) * extinction.c[2],
                 (1 / 4.0f) * extinction.c[3]}};
    }
    LAMINA_INLINE Float extinction_at(Float t, Float) const { return max(extinction.at(t), 0); }

  private:
    // Coefficients of the cubic that is 1 at one node of GaussRule<4> and 0 at the others.
    static constexpr float through_nodes[4][4] = {
        {1.52678813f, -0.813632449f, 0.40076152f, -0.113917196f},
        {-8.54602361f, 13.8071669f, -7.41707042f, 2.1559271f},
        {14.3258584f, -31.3882224f, 24.9981259f, -7.93576185f},
        {-7.42054007f, 18.7954494f, -18.7954494f, 7.42054007f}};
};

// Returns Q of (9.4) by Gauss' rule: the place in the interval, weighted by emission and
// transmittance. `opacity`: that of `depth`, which is at most largest_piece_depth. Only the place's
// slope is left for the rule, so a constant place is exact.
template <std::size_t points, bool curved>
LAMINA_INLINE Float seen_share(const PieceOptics<curved>& piece, Float depth, Float opacity) {
    using Rule = GaussRule<points>;
    const CubicLanes& share = piece.share;
    const CubicLanes mean_depth = piece.mean_depth();
    const Float all = shallow_opacity(depth);
    Float sum = opacity * share.c[0];
    for (std::size_t i = 0; i < points; ++i) {
        constexpr auto& nodes = Rule::nodes;
        const Float t(nodes[i]);
        const Float before = t * mean_depth.at(t);
        const float weight = Rule::weights[i];
        const Float slope = weight * share.c[1] + (2 * weight * nodes[i]) * share.c[2] +
                            (3 * weight * nodes[i] * nodes[i]) * share.c[3];
        sum += slope * (all - shallow_opacity(before));
    }
    return clamp(sum, 0, opacity);
}

LAMINA_SIMD_END

#endif

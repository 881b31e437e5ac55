// SPDX-License-Identifier: Apache-2.0
// Computes the scalar s along a segment, a cubic, and emission and absorption of a piece in one
// interval of the transfer function (docs/numerics.md, section 9; equations in brackets).
//
//   c0 .. c3 = the cubic's coefficients, from the corners, the entry and the way in the cell (9.1)
//   range    = least and largest of its four Bernstein coefficients                       (9.5)
//   turns    = roots of s'(t) in 0 .. 1
//   root     = the place between two turns at which s is k                                (9.6)
//
//   q(t)     = the place in the interval, 0 .. 1: the cubic, scaled
//   depth    = length (a + b mean of q)                                                   (9.2)
//   opacity  = 1 - exp(-depth)
//   Q        = q(0) opacity + int q'(t) (exp(-D(t)) - exp(-D(1))) dt, by Gauss' rule      (9.4)
//   color    = c0 opacity + (c1 - c0) Q                                                   (9.3)
//
// A curved interval's extinction is a cubic of q instead of a + b q; depth is its mean.
#if defined(LAMINA_SLICING_CPU_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_OPTICS_INL_H_
#undef LAMINA_SLICING_CPU_OPTICS_INL_H_
#else
#define LAMINA_SLICING_CPU_OPTICS_INL_H_
#endif

#include <limits>

#include "executors/cpu_transfer-inl.h"
#include "slicing/cpu_fetch-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

// A cubic polynomial of t, 0 <= t <= 1: c[0] + c[1] t + c[2] t^2 + c[3] t^3.
struct CubicLanes {
    Float c[4];

    LAMINA_INLINE Float at(Float t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    LAMINA_INLINE Float slope(Float t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3])); }
    LAMINA_INLINE Float mean() const {
        return c[0] + (1 / 2.0f) * c[1] + (1 / 3.0f) * c[2] + (1 / 4.0f) * c[3];
    }
};

// Returns the trilinear field of a cell, minus `base`, at place + t * change, as a cubic of t. It
// is computed from differences of corners, so that a constant cell gives an exact constant.
LAMINA_INLINE CubicLanes cubic_along(const Corners& corners, Float base, const Float (&place)[3],
                                     const Float (&change)[3]) {
    const Float v0 = corners.lower[0], v1 = corners.upper[0], v2 = corners.lower[1],
                v3 = corners.upper[1], v4 = corners.lower[2], v5 = corners.upper[2],
                v6 = corners.lower[3], v7 = corners.upper[3];
    const Float x = v1 - v0, y = v2 - v0, z = v4 - v0;
    const Float xy = (v3 - v2) - x, xz = (v5 - v4) - x, yz = (v6 - v4) - y;
    const Float xyz = ((v7 - v6) - (v5 - v4)) - xy;
    const auto& [u, v, w] = place;
    const auto& [du, dv, dw] = change;
    // Mixed second derivatives (xy, xz, yz) at the entry.
    const Float xy_there = xy + w * xyz, xz_there = xz + v * xyz, yz_there = yz + u * xyz;
    CubicLanes field;
    field.c[0] = (v0 - base) + u * (x + v * xy_there) + v * (y + w * yz) + w * (z + u * xz);
    field.c[1] = du * (x + v * xy_there + w * xz) + dv * (y + u * xy_there + w * yz) +
                 dw * (z + u * (xz + v * xyz) + v * yz);
    field.c[2] = du * dv * xy_there + dw * (du * xz_there + dv * yz_there);
    field.c[3] = du * dv * dw * xyz;
    return field;
}

struct RangeLanes {
    Float lo, hi;

    LAMINA_INLINE Float clamped(Float scalar) const { return min(max(scalar, lo), hi); }
};

// Returns the scalars that a segment at place + t * change shows: those between its corners' least
// and largest. On an axis on which it stays in a face, as it does beyond the samples of `cell`
// axes, the corners of the other face do not count. The least and the largest themselves are shown
// by constant fields alone; others meet them in a set of no volume. So they are left out, by a few
// roundings of a scalar in 0 .. 1: else a rounding would put a ray that only touches a step of the
// transfer function on its other side (docs/numerics.md, section 9.3).
LAMINA_INLINE RangeLanes limits_of(const Corners& corners, Float base, float scale,
                                   const Float (&place)[3], const Float (&change)[3]) {
    FloatMask left_out[3][2];  // by axis: the lower corners, the upper ones
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const FloatMask stays = change[axis] == 0;
        left_out[axis][0] = stays & (place[axis] >= 1);
        left_out[axis][1] = stays & (place[axis] <= 0);
    }
    Float least(std::numeric_limits<float>::max()), largest = -least;
    const auto include = [&](Float v, FloatMask unseen) LAMINA_LAMBDA {
        least = select(unseen, least, min(least, v));
        largest = select(unseen, largest, max(largest, v));
    };
    for (std::size_t i = 0; i < 4; ++i) {
        const FloatMask unseen = left_out[1][i % 2] | left_out[2][i / 2];
        include(corners.lower[i], unseen | left_out[0][0]);
        include(corners.upper[i], unseen | left_out[0][1]);
    }
    const Float lo = (least - base) * scale, hi = (largest - base) * scale;
    const Float margin = min(0.5f * (hi - lo), 0x1p-23f);
    return {lo + margin, hi - margin};
}

// Returns bounds on the cubic: its least and largest Bernstein coefficient.
LAMINA_INLINE RangeLanes range_of(const CubicLanes& cubic) {
    const Float third = Float(1 / 3.0f);
    const Float one = cubic.c[0] + third * cubic.c[1];
    const Float two = one + third * (cubic.c[1] + cubic.c[2]);
    const Float end = cubic.c[0] + cubic.c[1] + cubic.c[2] + cubic.c[3];
    return {min(min(cubic.c[0], one), min(two, end)), max(max(cubic.c[0], one), max(two, end))};
}

// The places in 0 .. 1, in order, between which the cubic is monotone; 1 for missing ones.
struct Turns {
    Float first, second;
};

LAMINA_INLINE Turns turns_of(const CubicLanes& cubic) {
    // The quotient form has no cancellation (Press et al., Numerical Recipes, 5.6).
    const Float a = 3 * cubic.c[3], b = cubic.c[2], c = cubic.c[1];
    const Float discriminant = b * b - a * c;
    const Float root = sqrt(max(discriminant, 0));
    const Float q = 0 - (b + copy_sign(root, b));
    const auto inside = [&](Float turn) LAMINA_LAMBDA {
        const FloatMask is = (turn > 0) & (turn < 1) & (discriminant > 0);
        return select(is, turn, 1);  // not a number if a or q is 0
    };
    const Float one = inside(q / a), other = inside(c / q);
    return {min(one, other), max(one, other)};
}

// Finds the t at which a cubic that is monotone in a bracket has a given value: steps to the root
// of the touching parabola (9.6), or bisects. Converges with third order, also near turns.
struct RootLanes {
    Float t;

    // Begins in the lanes `wanted`. The cubic is at_from at `from` and at_to at `to`, the bracket.
    LAMINA_INLINE void begin(Float value, Float from, Float to, Float at_from, Float at_to,
                             FloatMask wanted) {
        value_ = value;
        low_ = from;
        high_ = to;
        rising_ = at_to >= at_from;
        active_ = wanted;
        const Float share = (value - at_from) / (at_to - at_from);
        t = from + (to - from) * clamp(share, 0, 1);
    }

    LAMINA_INLINE bool found() const { return none_of(active_); }

    LAMINA_INLINE void refine(const CubicLanes& cubic) {
        // A step below this is the last: the next one would be of the order of its third power.
        const Float small = Float(3e-3f);
        const Float rest = cubic.at(t) - value_;
        const FloatMask before = !((rest < 0) ^ rising_);
        low_ = select(before, t, low_);
        high_ = select(before, high_, t);
        const Float slope = cubic.slope(t), bend = cubic.c[2] + 3 * cubic.c[3] * t;
        // The root of the touching parabola at which it rises or falls as the cubic does.
        const Float square = max(slope * slope - 4 * rest * bend, 0);
        const Float root = sqrt(square);
        const Float divisor = select(rising_, slope + root, slope - root);
        const Float nearer = t - (rest + rest) / divisor;
        const FloatMask inside = (nearer >= low_) & (nearer <= high_);
        const Float next = select(inside, nearer, 0.5f * (low_ + high_));
        const Float step = abs(next - t);
        t = select(active_, next, t);
        active_ = active_ & (step > small);
    }

  private:
    Float value_, low_, high_;
    FloatMask rising_, active_;
};

// The bends of an interval's extinction (CpuTransfer::bend); straight intervals have none.
template <bool curved>
struct IntervalBend {};
template <>
struct IntervalBend<true> {
    Float bend[2];
};

// An interval of the transfer function in each lane. Colour is linear in the share, the place in
// the interval from 0 at its left end to 1 at its right. Extinction is linear, too, or curved.
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

// Looks up intervals. Copying and transposing records is faster than a gather for each number.
template <bool curved>
LAMINA_INLINE IntervalLanes<curved> fetched_intervals(const CpuTransfer& transfer, Int number) {
    constexpr std::size_t groups = curved ? 4 : 3, size = 4;
    alignas(64) std::int32_t numbers[most_lanes];
    alignas(64) float records[groups][size * most_lanes];
    store(number, numbers);
    for (std::size_t lane = 0; lane < Float::lanes; ++lane) {
        const float* const from =
            transfer.records.data() +
            CpuTransfer::record_size * static_cast<std::size_t>(numbers[lane]);
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
LAMINA_INLINE IntervalLanes<curved> interval_lanes(const CpuTransfer& transfer, Int number) {
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

// Emission and absorption along a piece: the share of the interval as a cubic, and extinction times
// the piece's length.
template <bool curved>
struct PieceOptics;

// In a straight interval: extinction at share 0, and its change up to share 1.
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

    // Returns the optical depth, exactly: if extinction changes, the share is a cubic in 0 .. 1.
    // The clamp is for samples far outside the range, beside which the cubic is less exact.
    LAMINA_INLINE Float depth() const {
        const Float mean = clamp01(share.mean());
        return max(extinction + change * mean, 0);
    }
    // Returns the cubic whose value at t, times t, is the optical depth up to t.
    LAMINA_INLINE CubicLanes mean_depth() const {
        return {{extinction + change * share.c[0], change * ((1 / 2.0f) * share.c[1]),
                 change * ((1 / 3.0f) * share.c[2]), change * ((1 / 4.0f) * share.c[3])}};
    }
    // Returns the extinction at t, where the share is `there`.
    LAMINA_INLINE Float extinction_at(Float, Float there) const {
        return max(extinction + change * there, 0);
    }
};

// In a curved interval: extinction is a cubic through its values at four nodes of Gauss' rule, so
// that the optical depth is exact if the extinction along the piece is a polynomial of degree 7.
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
    // Column i: the cubic, constant first, that is 1 at node i of GaussRule<4>, 0 at the others.
    static constexpr float through_nodes[4][4] = {
        {1.52678813f, -0.813632449f, 0.40076152f, -0.113917196f},
        {-8.54602361f, 13.8071669f, -7.41707042f, 2.1559271f},
        {14.3258584f, -31.3882224f, 24.9981259f, -7.93576185f},
        {-7.42054007f, 18.7954494f, -18.7954494f, 7.42054007f}};
};

// Returns Q of (9.4) by Gauss' rule: the share, weighted by emission and transmittance. Only its
// slope is integrated, so a constant share is exact. `opacity`: of `depth` <= largest_piece_depth.
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

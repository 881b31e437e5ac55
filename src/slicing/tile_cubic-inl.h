// SPDX-License-Identifier: Apache-2.0
// The scalar along a part of a ray inside one cell: a cubic, as a trilinear field is along every
// straight line (docs/numerics.md, section 9).
#if defined(LAMINA_SLICING_TILE_CUBIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CUBIC_INL_H_
#undef LAMINA_SLICING_TILE_CUBIC_INL_H_
#else
#define LAMINA_SLICING_TILE_CUBIC_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_number-inl.h"
#include "slicing/tile_scalars-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// c[0] + t (c[1] + t (c[2] + t c[3])), 0 <= t <= 1.
struct CubicLanes {
    Number c[4];

    HWY_INLINE Number at(Number t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    HWY_INLINE Number slope(Number t) const {
        return c[1] + t * (Number(2) * c[2] + t * (Number(3) * c[3]));
    }
    HWY_INLINE Number mean() const {
        return c[0] + Number(1 / 2.0f) * c[1] + Number(1 / 3.0f) * c[2] + Number(1 / 4.0f) * c[3];
    }
};

// The trilinear field of a cell, less `base`, along place + t * change. It is computed from
// differences of corners, so that a constant cell is exactly constant.
HWY_INLINE CubicLanes cubic_along(const Corners& corners, Number base, const Number (&place)[3],
                                  const Number (&change)[3]) {
    const Number v0 = corners.lower[0], v1 = corners.upper[0], v2 = corners.lower[1],
                 v3 = corners.upper[1], v4 = corners.lower[2], v5 = corners.upper[2],
                 v6 = corners.lower[3], v7 = corners.upper[3];
    const Number x = v1 - v0, y = v2 - v0, z = v4 - v0;
    const Number xy = (v3 - v2) - x, xz = (v5 - v4) - x, yz = (v6 - v4) - y;
    const Number xyz = ((v7 - v6) - (v5 - v4)) - xy;
    const auto& [u, v, w] = place;
    const auto& [du, dv, dw] = change;
    // Second derivatives at the entry.
    const Number xy_there = xy + w * xyz, xz_there = xz + v * xyz, yz_there = yz + u * xyz;
    CubicLanes field;
    field.c[0] = (v0 - base) + u * (x + v * xy_there) + v * (y + w * yz) + w * (z + u * xz);
    field.c[1] = du * (x + v * xy_there + w * xz) + dv * (y + u * xy_there + w * yz) +
                 dw * (z + u * (xz + v * xyz) + v * yz);
    field.c[2] = du * dv * xy_there + dw * (du * xz_there + dv * yz_there);
    field.c[3] = du * dv * dw * xyz;
    return field;
}

struct RangeLanes {
    Number lo, hi;
};

// Bounds on the cubic: its Bernstein coefficients.
HWY_INLINE RangeLanes range_of(const CubicLanes& cubic) {
    const Number third = Number(1 / 3.0f);
    const Number one = cubic.c[0] + third * cubic.c[1];
    const Number two = one + third * (cubic.c[1] + cubic.c[2]);
    const Number end = cubic.c[0] + cubic.c[1] + cubic.c[2] + cubic.c[3];
    return {min(min(cubic.c[0], one), min(two, end)), max(max(cubic.c[0], one), max(two, end))};
}

// The places in 0 .. 1, in order, between which the cubic is monotone; 1 where there are fewer.
struct Turns {
    Number first, second;
};

HWY_INLINE Turns turns_of(const CubicLanes& cubic) {
    const FloatTag d;
    // The quotient form has no cancellation (Press et al., Numerical Recipes, 5.6).
    const Number a = Number(3) * cubic.c[3], b = cubic.c[2], c = cubic.c[1];
    const Number discriminant = b * b - a * c;
    const Number root = hn::Sqrt(hn::Max(discriminant.v, hn::Zero(d)));
    const Number q = Number(0) - (b + Number(hn::CopySign(root.v, b.v)));
    const auto inside = [&](Number turn) HWY_ATTR {
        const FloatMask is =
            hn::And(hn::And(turn > Number(0), turn < Number(1)), discriminant > Number(0));
        return select(is, turn, Number(1));  // not a number where a or q is 0
    };
    const Number one = inside(q / a), other = inside(c / q);
    return {min(one, other), max(one, other)};
}

// The place where a cubic, which is monotone between two places, has a value: roots of parabolas
// that touch the cubic (Euler's method) in a bracket. It converges with the third order, and near
// places where the cubic turns, too.
struct RootLanes {
    Number t;

    // The cubic is `at_from` and `at_to` at its two places. Lanes outside `wanted` get any place.
    HWY_INLINE void begin(Number value, Number from, Number to, Number at_from, Number at_to,
                          FloatMask wanted) {
        value_ = value;
        low_ = from;
        high_ = to;
        rising_ = at_to >= at_from;
        active_ = wanted;
        const Number share = (value - at_from) / (at_to - at_from);
        t = from + (to - from) * min(max(share, Number(0)), Number(1));
    }

    HWY_INLINE bool found() const { return hn::AllFalse(FloatTag(), active_); }

    HWY_INLINE void refine(const CubicLanes& cubic) {
        // The next step would be of the order of this one to the third power.
        const Number small = Number(3e-3f);
        const Number rest = cubic.at(t) - value_;
        const FloatMask before = hn::Not(hn::Xor(rest < Number(0), rising_));
        low_ = select(before, t, low_);
        high_ = select(before, high_, t);
        const Number slope = cubic.slope(t), bend = cubic.c[2] + Number(3) * cubic.c[3] * t;
        // The root of the parabola through this place, with the sign of the slope.
        const Number square = max(slope * slope - Number(4) * rest * bend, Number(0));
        const Number root = hn::Sqrt(square.v);
        const Number divisor = select(rising_, slope + root, slope - root);
        const Number nearer = t - (rest + rest) / divisor;
        const FloatMask inside = hn::And(nearer >= low_, nearer <= high_);
        const Number next = select(inside, nearer, Number(0.5f) * (low_ + high_));
        const Number step = hn::Abs((next - t).v);
        t = select(active_, next, t);
        active_ = hn::And(active_, step > small);
    }

  private:
    Number value_, low_, high_;
    FloatMask rising_, active_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

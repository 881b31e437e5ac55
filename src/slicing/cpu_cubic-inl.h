// SPDX-License-Identifier: Apache-2.0
// The scalar along a segment: a cubic (docs/numerics.md, section 9.1; numbers in brackets are
// equations there).
//
//   c0 .. c3 = its coefficients, from the corners, the entry and the way in the cell (9.1)
//   range    = least and largest of its four Bernstein coefficients                  (9.5)
//   turns    = roots of s'(t) in 0 .. 1
//   root     = the place between two turns at which s is k                           (9.6)
#if defined(LAMINA_SLICING_CPU_CUBIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_CUBIC_INL_H_
#undef LAMINA_SLICING_CPU_CUBIC_INL_H_
#else
#define LAMINA_SLICING_CPU_CUBIC_INL_H_
#endif

#include "simd/vectors-inl.h"
#include "slicing/cpu_fetch-inl.h"

LAMINA_SIMD_BEGIN

// c[0] + t (c[1] + t (c[2] + t c[3])), 0 <= t <= 1.
struct CubicLanes {
    Float c[4];

    LAMINA_INLINE Float at(Float t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    LAMINA_INLINE Float slope(Float t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3])); }
    LAMINA_INLINE Float mean() const {
        return c[0] + (1 / 2.0f) * c[1] + (1 / 3.0f) * c[2] + (1 / 4.0f) * c[3];
    }
};

// Returns the trilinear field of a cell minus `base`, along place + t * change. It is computed from
// differences of corners, so that a constant cell is exactly constant.
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
    // Second derivatives at the entry.
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
};

// Returns bounds on the cubic: its Bernstein coefficients.
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

// Finds the place at which a cubic, monotone between two places, has a value: roots of parabolas
// that touch the cubic (Euler's method) in a bracket. It converges with the third order, also near
// places where the cubic turns.
struct RootLanes {
    Float t;

    // The cubic is `at_from` and `at_to` at its two places. Lanes outside `wanted` get any place.
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
        // The next step would be of the order of this one to the third power.
        const Float small = Float(3e-3f);
        const Float rest = cubic.at(t) - value_;
        const FloatMask before = !((rest < 0) ^ rising_);
        low_ = select(before, t, low_);
        high_ = select(before, high_, t);
        const Float slope = cubic.slope(t), bend = cubic.c[2] + 3 * cubic.c[3] * t;
        // The root of the parabola through this place, with the sign of the slope.
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

LAMINA_SIMD_END

#endif

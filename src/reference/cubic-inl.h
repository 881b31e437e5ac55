// SPDX-License-Identifier: Apache-2.0
// Vectors of cubics: the functions of cubic.h.
#if defined(LAMINA_REFERENCE_CUBIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_CUBIC_INL_H_
#undef LAMINA_REFERENCE_CUBIC_INL_H_
#else
#define LAMINA_REFERENCE_CUBIC_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "reference/cubic.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

struct Cubics {
    Double c[4];

    LAMINA_INLINE Double at(Double t) const {
        return fma(fma(fma(c[3], t, c[2]), t, c[1]), t, c[0]);
    }
    LAMINA_INLINE Double slope(Double t) const {
        const Double end = fma(3 * c[3], t, 2 * c[2]);
        return fma(end, t, c[1]);
    }
    LAMINA_INLINE DoubleMask constant() const { return (c[1] == 0) & ((c[2] == 0) & (c[3] == 0)); }
};

// The places at which cubics turn, 0 < first < second < 1; 1 in lanes in which they do not.
struct Turns {
    Double first, second;
};

LAMINA_INLINE Turns turns_of(const Cubics& cubics) {
    Double a = 3 * cubics.c[3], b = cubics.c[2], c = cubics.c[1];
    const Double largest = max(abs(a), max(abs(b), abs(c)));
    a = a / largest;
    b = b / largest;
    c = c / largest;
    const Double discriminant = fms(b, b, a * c);
    const DoubleMask real = discriminant > 0;
    const Double root = sqrt(zero_unless(real, discriminant));
    const Double q = -(b + copy_sign(root, b));
    // A root is infinite, or no number, if there is no second power: not kept.
    const auto inside = [&](Double at) LAMINA_LAMBDA {
        const DoubleMask kept = real & ((at > 0) & (at < 1));
        return select(kept, at, 1);
    };
    const Double x = inside(q / a), y = inside(c / q);
    const Double first = min(x, y), second = max(x, y);
    return {first, select(second > first, second, 1)};
}

// Solves the lanes in `wanted` as the scalar solve_monotone() does.
LAMINA_INLINE Double solve_monotone(const Cubics& cubics, Double value, Double from, Double to,
                                    DoubleMask wanted) {
    Cubics shifted = cubics;
    shifted.c[0] = cubics.c[0] - value;
    const Double at_from = shifted.at(from), at_to = shifted.at(to);
    const DoubleMask falls = at_from > at_to;
    Double below = select(falls, to, from), above = select(falls, from, to);
    Double step = abs(to - from), previous_step = step;
    Double t = fma(to - from, at_from / (at_from - at_to), from);
    const DoubleMask between = (t > from) & (t < to);
    t = select(between, t, 0.5 * (from + to));
    const Double bend = fma(3, abs(cubics.c[3]), abs(cubics.c[2]));
    DoubleMask done = !wanted;
    for (int i = 0; i < most_newton_steps && !all_of(done); ++i) {
        const Double f = shifted.at(t), slope = shifted.slope(t);
        done = done | (f == 0);
        const DoubleMask negative = f < 0;
        below = select(without(negative, done), t, below);
        above = select(done | negative, above, t);
        const Double newton = t - f / slope;
        const DoubleMask inside = (newton > min(below, above)) & (newton < max(below, above));
        const DoubleMask fast = abs(f + f) <= abs(previous_step * slope);
        const DoubleMask by_newton = inside & fast;
        const Double next = select(by_newton, newton, 0.5 * (below + above));
        previous_step = step;
        step = abs(next - t);
        t = select(done, t, next);
        const Double rounding = root_precision * abs(t);
        const Double bent = bend / abs(slope) * step;
        const DoubleMask straight = (bent * step <= rounding) & (8 * bent <= 1);
        done = done | ((step <= rounding) | (by_newton & straight));
    }
    return t;
}

// Restricts as the scalar restricted() does.
LAMINA_INLINE Cubics restricted(const Cubics& cubics, Double from, Double to, Double start,
                                Double end) {
    const Double h = to - from, h2 = h * h;
    Cubics inside;
    inside.c[0] = start;
    inside.c[1] = cubics.slope(from) * h;
    inside.c[2] = fma(3 * cubics.c[3], from, cubics.c[2]) * h2;
    inside.c[3] = cubics.c[3] * (h2 * h);
    const Double sum = inside.c[1] + (inside.c[2] + inside.c[3]);
    inside.c[1] += end - start - sum;
    return inside;
}

}  // namespace reference
LAMINA_SIMD_END

#endif

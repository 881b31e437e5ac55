// SPDX-License-Identifier: Apache-2.0
// Computes exp and log: takes powers of two out of the argument, then sums a polynomial.
#if defined(LAMINA_SIMD_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_MATH_INL_H_
#undef LAMINA_SIMD_MATH_INL_H_
#else
#define LAMINA_SIMD_MATH_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// Returns 2^n for whole n from -126 to 127.
LAMINA_INLINE Float power_of_two(Int n) {
    return bits_as<Float>(shift_left<23>(n + 127));
}

// Returns exp(x) to a relative 2e-7 for |x| < 87; about 1e-38 for smaller x, 2e38 for larger.
LAMINA_INLINE Float exp_of(Float x) {
    const Float inside = clamp(x, -87.3f, 88.3f);
    const Int n = nearest_int(inside * 1.44269504f);
    const Float whole = to_float(n);
    // log(2) is split into two numbers, the first with few digits (Cody, Waite 1980).
    const Float f = (inside - whole * 0.693359375f) - whole * -2.12194440e-4f;
    // The last five terms interpolate (exp(f) - 1 - f) / f^2 at Chebyshev's nodes, to 1e-8.
    constexpr float series[] = {1.0f,          1.0f,           0.5f,          0.166665768f,
                                0.0416665544f, 8.36320297e-3f, 1.39262135e-3f};
    // 2^n is applied in two factors, because it may itself not be a normal number.
    const Int half = shift_right<1>(n);
    return polynomial(f, series) * power_of_two(half) * power_of_two(n - half);
}

// Returns log(x) for x >= 1e-37, to a relative 2e-7 or, near 1, an absolute 6e-8.
LAMINA_INLINE Float log_of(Float x) {
    // x = 2^n m with sqrt(1/2) <= m < sqrt(2); log(m) = 2 artanh((m - 1) / (m + 1)).
    const Int bits = bits_as<Int>(x);
    const Int n = shift_right<23>(bits - 0x3f3504f3);
    const Float m = bits_as<Float>(bits - shift_left<23>(n));
    const Float z = (m - 1) / (m + 1);
    constexpr float series[] = {2.0f, 0.666666667f, 0.4f, 0.285714286f, 0.222222222f};
    const Float whole = to_float(n);
    const Float log_m = z * polynomial(z * z, series);
    return whole * 0.693359375f + (log_m + whole * -2.12194440e-4f);
}

// Return exp(x) and exp(x) - 1, accurate to the last few digits of double precision.
LAMINA_INLINE Double exp(Double x) {
    return hn::Exp(Double::Tag(), x.v);
}
LAMINA_INLINE Double expm1(Double x) {
    return hn::Expm1(Double::Tag(), x.v);
}

LAMINA_SIMD_END

#endif

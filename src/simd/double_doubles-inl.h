// SPDX-License-Identifier: Apache-2.0
// Vector form of DoubleDouble (the sum of two doubles, some 32 digits), with equal rounding.
#if defined(LAMINA_SIMD_DOUBLE_DOUBLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_DOUBLE_DOUBLES_INL_H_
#undef LAMINA_SIMD_DOUBLE_DOUBLES_INL_H_
#else
#define LAMINA_SIMD_DOUBLE_DOUBLES_INL_H_
#endif

#include "simd/lane_set.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// True if the instruction set computes fma() with one rounding.
inline constexpr bool has_fma = HWY_NATIVE_FMA != 0;

struct DoubleDoubles {
    Double hi, lo;

    DoubleDoubles() = default;
    LAMINA_INLINE DoubleDoubles(Double high, Double low) : hi(high), lo(low) {}
    LAMINA_INLINE DoubleDoubles(Double value) : hi(value), lo(0.0) {}
    LAMINA_INLINE DoubleDoubles(double value) : hi(value), lo(0.0) {}

    LAMINA_INLINE Double rounded() const { return hi + lo; }
    LAMINA_INLINE DoubleMask finite() const { return is_finite(hi) & is_finite(lo); }
};

// Returns a + b without error, whichever is larger (Knuth's two-sum).
LAMINA_INLINE DoubleDoubles exact_sum(Double a, Double b) {
    const Double sum = a + b;
    const Double b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// Returns a * b without error: fma() gives what the rounded product leaves.
LAMINA_INLINE DoubleDoubles exact_product(Double a, Double b) {
    const Double product = a * b;
    if constexpr (has_fma) return {product, fms(a, b, product)};
    alignas(64) double as[longest_vector], bs[longest_vector], rest[longest_vector];
    store(a, as);
    store(b, bs);
    store(product, rest);
    for (std::size_t lane = 0; lane < Double::lanes; ++lane)
        rest[lane] = std::fma(as[lane], bs[lane], -rest[lane]);
    return {product, load<Double>(rest)};
}

LAMINA_INLINE DoubleDoubles operator-(DoubleDoubles a) {
    return {-a.hi, -a.lo};
}

LAMINA_INLINE DoubleDoubles operator+(DoubleDoubles a, DoubleDoubles b) {
    const DoubleDoubles high = exact_sum(a.hi, b.hi);
    const DoubleDoubles low = exact_sum(a.lo, b.lo);
    const DoubleDoubles middle = exact_sum(high.hi, high.lo + low.hi);
    return exact_sum(middle.hi, middle.lo + low.lo);
}

LAMINA_INLINE DoubleDoubles operator-(DoubleDoubles a, DoubleDoubles b) {
    return a + -b;
}

LAMINA_INLINE DoubleDoubles operator*(DoubleDoubles a, DoubleDoubles b) {
    const DoubleDoubles product = exact_product(a.hi, b.hi);
    const Double rest = a.hi * b.lo + a.lo * b.hi;
    return exact_sum(product.hi, product.lo + rest);
}

LAMINA_INLINE DoubleDoubles operator/(DoubleDoubles a, DoubleDoubles b) {
    const Double first = a.hi / b.hi;
    const DoubleDoubles rest = a - b * first;
    const Double second = rest.hi / b.hi;
    const Double third = (rest - b * second).hi / b.hi;
    return exact_sum(first, second) + third;
}

LAMINA_INLINE DoubleMask operator<(DoubleDoubles a, DoubleDoubles b) {
    return (a.hi < b.hi) | ((a.hi == b.hi) & (a.lo < b.lo));
}

LAMINA_INLINE DoubleDoubles select(DoubleMask mask, DoubleDoubles yes, DoubleDoubles no) {
    return {select(mask, yes.hi, no.hi), select(mask, yes.lo, no.lo)};
}

LAMINA_SIMD_END

#endif

// SPDX-License-Identifier: Apache-2.0
// The lanes of a Float in double precision: two vectors of doubles that are written as one.
#if defined(LAMINA_SIMD_FLOAT64_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_FLOAT64_INL_H_
#undef LAMINA_SIMD_FLOAT64_INL_H_
#else
#define LAMINA_SIMD_FLOAT64_INL_H_
#endif

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

struct Float64Mask {
    DoubleMask low, high;

    friend LAMINA_INLINE Float64Mask operator&(Float64Mask a, Float64Mask b) {
        return {a.low & b.low, a.high & b.high};
    }
    friend LAMINA_INLINE Float64Mask operator|(Float64Mask a, Float64Mask b) {
        return {a.low | b.low, a.high | b.high};
    }
    friend LAMINA_INLINE bool any_of(Float64Mask a) { return any_of(a.low) || any_of(a.high); }
    friend LAMINA_INLINE bool none_of(Float64Mask a) { return none_of(a.low) && none_of(a.high); }
    friend LAMINA_INLINE bool all_of(Float64Mask a) { return all_of(a.low) && all_of(a.high); }
};

// `low` holds the first half of the lanes.
struct Float64 {
    using Scalar = double;
    using Mask = Float64Mask;

    Double low, high;

    Float64() = default;
    LAMINA_INLINE Float64(Double first, Double last) : low(first), high(last) {}
    LAMINA_INLINE Float64(double all) : low(all), high(all) {}
    LAMINA_INLINE explicit Float64(Float a)
        : low(hn::PromoteTo(Double::Tag(), hn::LowerHalf(hn::Half<Float::Tag>(), a.v))),
          high(hn::PromoteTo(Double::Tag(), hn::UpperHalf(hn::Half<Float::Tag>(), a.v))) {}
    LAMINA_INLINE explicit Float64(Int a)
        : low(hn::PromoteTo(Double::Tag(), hn::LowerHalf(hn::Half<Int::Tag>(), a.v))),
          high(hn::PromoteTo(Double::Tag(), hn::UpperHalf(hn::Half<Int::Tag>(), a.v))) {}
    // Converts exactly, by way of signed numbers, for which there is an instruction.
    LAMINA_INLINE explicit Float64(Word a)
        : Float64(Float64(bits_as<Int>(a ^ Word(0x80000000u))) + Float64(0x1p31)) {}

    friend LAMINA_INLINE Float64 operator+(Float64 a, Float64 b) {
        return {a.low + b.low, a.high + b.high};
    }
    friend LAMINA_INLINE Float64 operator-(Float64 a, Float64 b) {
        return {a.low - b.low, a.high - b.high};
    }
    friend LAMINA_INLINE Float64 operator*(Float64 a, Float64 b) {
        return {a.low * b.low, a.high * b.high};
    }
    friend LAMINA_INLINE Float64 operator/(Float64 a, Float64 b) {
        return {a.low / b.low, a.high / b.high};
    }
    friend LAMINA_INLINE Float64 operator-(Float64 a) { return {-a.low, -a.high}; }
    friend LAMINA_INLINE Float64& operator+=(Float64& a, Float64 b) { return a = a + b; }
    friend LAMINA_INLINE Float64& operator*=(Float64& a, Float64 b) { return a = a * b; }

    friend LAMINA_INLINE Float64Mask operator<(Float64 a, Float64 b) {
        return {a.low < b.low, a.high < b.high};
    }
    friend LAMINA_INLINE Float64Mask operator>(Float64 a, Float64 b) {
        return {a.low > b.low, a.high > b.high};
    }
    friend LAMINA_INLINE Float64Mask operator<=(Float64 a, Float64 b) {
        return {a.low <= b.low, a.high <= b.high};
    }
    friend LAMINA_INLINE Float64Mask operator>=(Float64 a, Float64 b) {
        return {a.low >= b.low, a.high >= b.high};
    }
    friend LAMINA_INLINE Float64Mask operator==(Float64 a, Float64 b) {
        return {a.low == b.low, a.high == b.high};
    }

    friend LAMINA_INLINE Float64 min(Float64 a, Float64 b) {
        return {min(a.low, b.low), min(a.high, b.high)};
    }
    friend LAMINA_INLINE Float64 max(Float64 a, Float64 b) {
        return {max(a.low, b.low), max(a.high, b.high)};
    }
    friend LAMINA_INLINE Float64 clamp(Float64 a, Float64 least, Float64 most) {
        return min(max(a, least), most);
    }
    friend LAMINA_INLINE Float64 abs(Float64 a) { return {abs(a.low), abs(a.high)}; }
    friend LAMINA_INLINE Float64 sqrt(Float64 a) { return {sqrt(a.low), sqrt(a.high)}; }
    friend LAMINA_INLINE Float64 floor(Float64 a) { return {floor(a.low), floor(a.high)}; }
    friend LAMINA_INLINE Float64 ceil(Float64 a) { return {ceil(a.low), ceil(a.high)}; }

    friend LAMINA_INLINE Float64 select(Float64Mask mask, Float64 yes, Float64 no) {
        return {select(mask.low, yes.low, no.low), select(mask.high, yes.high, no.high)};
    }
    friend LAMINA_INLINE Float64 zero_unless(Float64Mask mask, Float64 a) {
        return {zero_unless(mask.low, a.low), zero_unless(mask.high, a.high)};
    }

    friend LAMINA_INLINE void store(Float64 a, double* to) {
        store(a.low, to);
        store(a.high, to + Double::lanes);
    }
    friend LAMINA_INLINE double least_of(Float64 a) { return least_of(min(a.low, a.high)); }
    friend LAMINA_INLINE double largest_of(Float64 a) { return largest_of(max(a.low, a.high)); }
};

// Rounds to the nearest float.
LAMINA_INLINE Float to_float(const Float64& a) {
    const hn::Half<Float::Tag> half;
    return hn::Combine(Float::Tag(), hn::DemoteTo(half, a.high.v), hn::DemoteTo(half, a.low.v));
}
// Converts whole numbers within the range of int.
LAMINA_INLINE Int to_int(const Float64& whole) {
    const hn::Half<Int::Tag> half;
    return hn::Combine(Int::Tag(), hn::DemoteTo(half, whole.high.v),
                       hn::DemoteTo(half, whole.low.v));
}
LAMINA_INLINE Float64 load_float64(const double* from) {
    return {load<Double>(from), load<Double>(from + Double::lanes)};
}
// Returns the mask of the same lanes of a Float.
LAMINA_INLINE FloatMask to_float_mask(const Float64Mask& a) {
    return to_float(zero_unless(a, Float64(1.0))) > Float(0);
}
LAMINA_INLINE FloatMask to_float_mask(FloatMask a) {
    return a;
}

LAMINA_SIMD_END

#endif

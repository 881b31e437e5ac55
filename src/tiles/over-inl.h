// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/over.h, bit for bit. Codes are whole numbers. They are doubles for
// every number of bits, and may be floats up to max_float_over_bits and max_float_under_bits.
#if defined(LAMINA_TILES_OVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_OVER_INL_H_
#undef LAMINA_TILES_OVER_INL_H_
#else
#define LAMINA_TILES_OVER_INL_H_
#endif

#include "compositing/over.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// The rounded sum, up to M^2 + M / 2, is exact in the 24 bits of a float for M < 2^12. Its quotient
// by M is below 2^12 and so rounded by less than 2^-12. It cannot reach the next whole number,
// which is at least 1 / M away. For fused UNDER the numbers are M^3 + M^2 / 2 and 1 / M^2, so M <
// 2^8. Doubles hold the 49 bits of M < 2^16 and round quotients by less than 2^-37.
inline constexpr int max_float_over_bits = 12;
inline constexpr int max_float_under_bits = 8;

// Rounds x / n to the nearest whole number; n is odd.
template <class V>
LAMINA_INLINE V divide_nearest(V x, typename V::Scalar n) {
    return floor((x + (n - 1) / 2) / n);
}

template <class V>
LAMINA_INLINE V over(OverRounding rounding, V color, V alpha, V below, typename V::Scalar largest) {
    const V source = color * alpha;
    const V kept = below * (largest - alpha);
    return rounding == OverRounding::fused
               ? divide_nearest(source + kept, largest)
               : divide_nearest(source, largest) + divide_nearest(kept, largest);
}

template <class V>
LAMINA_INLINE V under(OverRounding rounding, V color, V alpha, V above, V above_alpha,
                      typename V::Scalar largest) {
    const V left = largest - above_alpha;
    const V product = color * alpha;
    if (rounding == OverRounding::separate) {
        const V source = divide_nearest(product, largest);
        return above + divide_nearest(source * left, largest);
    }
    return above + divide_nearest(product * left, largest * largest);
}

LAMINA_SIMD_END

#endif

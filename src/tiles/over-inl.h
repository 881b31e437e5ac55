// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/over.h, bit for bit. Codes are whole numbers. They are doubles for
// every number of bits, and may be floats up to max_float_over_bits and max_float_under_bits.
#if defined(LAMINA_TILES_OVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_OVER_INL_H_
#undef LAMINA_TILES_OVER_INL_H_
#else
#define LAMINA_TILES_OVER_INL_H_
#endif

#include <hwy/highway.h>

#include "compositing/over.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The rounded sum, up to M^2 + M / 2, is exact in the 24 bits of a float for M < 2^12. Its quotient
// by M is below 2^12 and so rounded by less than 2^-12. It cannot reach the next whole number,
// which is at least 1 / M away. For fused UNDER the numbers are M^3 + M^2 / 2 and 1 / M^2, so M <
// 2^8. Doubles hold the 49 bits of M < 2^16 and round quotients by less than 2^-37.
inline constexpr int max_float_over_bits = 12;
inline constexpr int max_float_under_bits = 8;

// x / n to the nearest whole number; n is odd.
template <class D>
HWY_INLINE hn::Vec<D> divide_nearest(D d, hn::Vec<D> x, hn::TFromD<D> n) {
    return hn::Floor(hn::Div(hn::Add(x, hn::Set(d, (n - 1) / 2)), hn::Set(d, n)));
}

template <class D>
HWY_INLINE hn::Vec<D> over(D d, OverRounding rounding, hn::Vec<D> color, hn::Vec<D> alpha,
                           hn::Vec<D> below, hn::TFromD<D> largest) {
    const auto source = hn::Mul(color, alpha);
    const auto kept = hn::Mul(below, hn::Sub(hn::Set(d, largest), alpha));
    return rounding == OverRounding::fused
               ? divide_nearest(d, hn::Add(source, kept), largest)
               : hn::Add(divide_nearest(d, source, largest), divide_nearest(d, kept, largest));
}

template <class D>
HWY_INLINE hn::Vec<D> under(D d, OverRounding rounding, hn::Vec<D> color, hn::Vec<D> alpha,
                            hn::Vec<D> above, hn::Vec<D> above_alpha, hn::TFromD<D> largest) {
    const auto left = hn::Sub(hn::Set(d, largest), above_alpha);
    const auto product = hn::Mul(color, alpha);
    if (rounding == OverRounding::separate) {
        const auto source = divide_nearest(d, product, largest);
        return hn::Add(above, divide_nearest(d, hn::Mul(source, left), largest));
    }
    return hn::Add(above, divide_nearest(d, hn::Mul(product, left), largest * largest));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// SPDX-License-Identifier: Apache-2.0
// The words of vectors for one double, for templates over the number type.
#if defined(LAMINA_SIMD_SCALAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_SCALAR_INL_H_
#undef LAMINA_SIMD_SCALAR_INL_H_
#else
#define LAMINA_SIMD_SCALAR_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE double min(double a, double b) {
    return std::min(a, b);
}
LAMINA_INLINE double max(double a, double b) {
    return std::max(a, b);
}
LAMINA_INLINE double clamp(double a, double least, double most) {
    return std::min(std::max(a, least), most);
}
LAMINA_INLINE double abs(double a) {
    return std::abs(a);
}
LAMINA_INLINE double sqrt(double a) {
    return std::sqrt(a);
}
LAMINA_INLINE double floor(double a) {
    return std::floor(a);
}
LAMINA_INLINE double select(bool mask, double yes, double no) {
    return mask ? yes : no;
}
LAMINA_INLINE double rounded_to_float(double a) {
    return static_cast<double>(static_cast<float>(a));
}

LAMINA_SIMD_END

#endif

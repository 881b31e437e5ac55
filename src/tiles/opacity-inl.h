// SPDX-License-Identifier: Apache-2.0
// Vector form of opacity_from_depth (optics/opacity.h), as in shaders/optics/opacity.glsl.
#if defined(LAMINA_TILES_OPACITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_OPACITY_INL_H_
#undef LAMINA_TILES_OPACITY_INL_H_
#else
#define LAMINA_TILES_OPACITY_INL_H_
#endif

#include <type_traits>

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// Returns the opacity of an optical depth >= 0, with a relative error of 3e-7 at every depth,
// infinity included. The shader gives the reasons.
LAMINA_INLINE Float opacity_from_depth(Float depth) {
    const Float octaves = min(depth * 1.4426950408889634f, 126.0f);
    const Int n = to_int(octaves + 0.5f);
    const Float f = to_float(n) - octaves;
    const Float power = bits_as<Float>(0x3f800000 - shift_left<23>(n));
    constexpr float slope[] = {0.693147187926693f,     0.24022649794962264f,
                               0.0555035743364266f,    0.009618237494907015f,
                               0.0013390735477607873f, 0.00015403512367553545f};
    return (1 - power) - power * (f * polynomial(f, slope));
}

// Returns the opacity in double precision, to 1e-13.
template <class V>
requires(std::is_same_v<typename V::Scalar, double>) LAMINA_INLINE V opacity_from_depth(V depth) {
    const V x = min(depth, 40.0) * (-1.0 / 256);
    V sum = x * (1.0 / 10) + 1.0;
    for (int i = 9; i >= 2; --i) sum = x * (1.0 / i) * sum + 1.0;
    V result = x * sum;
    for (int i = 0; i < 8; ++i) result = result * (2.0 + result);
    return -result;
}

LAMINA_SIMD_END

#endif

// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/codes.h, bit for bit, on vectors of doubles.
#if defined(LAMINA_TILES_DITHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_DITHER_INL_H_
#undef LAMINA_TILES_DITHER_INL_H_
#else
#define LAMINA_TILES_DITHER_INL_H_
#endif

#include "compositing/codes.h"
#include "tiles/codes-inl.h"

LAMINA_SIMD_BEGIN

template <class V>
LAMINA_INLINE V dither_code(V scaled, double rank, int period, int increment, double largest) {
    const double step = increment;
    const ScaledValues<V> value = split_scaled(scaled / step);
    const V terms = floor(static_cast<double>(period) * value.rest + code_noise);
    const V steps = step_up(value.whole, rank < terms);
    return select(scaled >= largest - code_noise, largest, min(steps * step, largest));
}

LAMINA_SIMD_END

#endif

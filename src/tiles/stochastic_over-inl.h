// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/over.h, bit for bit, on vectors of doubles.
#if defined(LAMINA_TILES_STOCHASTIC_OVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_STOCHASTIC_OVER_INL_H_
#undef LAMINA_TILES_STOCHASTIC_OVER_INL_H_
#else
#define LAMINA_TILES_STOCHASTIC_OVER_INL_H_
#endif

#include "tiles/codes-inl.h"

LAMINA_SIMD_BEGIN

// `random`: 32 random bits as a number.
template <class V>
LAMINA_INLINE V over_stochastic(V source, V alpha, V below, V random, double largest) {
    const ScaledValues<V> value = split_scaled(largest * source + below * (1.0 - alpha));
    return min(step_up(value.whole, random < value.rest * 0x1p32), largest);
}

LAMINA_SIMD_END

#endif

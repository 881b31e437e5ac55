// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/codes.h, bit for bit, on vectors of doubles: codes are whole numbers.
#if defined(LAMINA_TILES_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_CODES_INL_H_
#undef LAMINA_TILES_CODES_INL_H_
#else
#define LAMINA_TILES_CODES_INL_H_
#endif

#include "base/enum_words.h"
#include "compositing/codes.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

template <class V>
struct ScaledValues {
    V whole, rest;
};

template <class V>
LAMINA_INLINE ScaledValues<V> split_scaled(V scaled) {
    const V whole = floor(scaled + code_noise);
    return {whole, max(scaled - whole, 0)};
}

template <class V>
LAMINA_INLINE V code_nearest(V scaled) {
    return floor(scaled + 0.5);
}

// Returns `code`, or the next code if `up`.
template <class V>
LAMINA_INLINE V step_up(V code, typename V::Mask up) {
    return code + zero_unless(up, V(1.0));
}

// `random`: 32 random bits as a number, for stochastic rounding only.
template <class V>
LAMINA_INLINE V round_alpha(AlphaRounding rounding, const ScaledValues<V>& scaled, V random) {
    switch (rounding) {
        case AlphaRounding::truncate:
            return scaled.whole;
        case AlphaRounding::nearest:
            return step_up(scaled.whole, scaled.rest + code_noise >= 0.5);
        case AlphaRounding::stochastic:
            return step_up(scaled.whole, random < scaled.rest * 0x1p32);
    }
    unreachable_enum();
}

LAMINA_SIMD_END

#endif

// SPDX-License-Identifier: Apache-2.0
// Vector form of random_bits (compositing/codes.h), on vectors of 32-bit unsigned numbers.
#if defined(LAMINA_TILES_RANDOM_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_RANDOM_BITS_INL_H_
#undef LAMINA_TILES_RANDOM_BITS_INL_H_
#else
#define LAMINA_TILES_RANDOM_BITS_INL_H_
#endif

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE Word random_bits(Word column, Word row, Word sample, Word seed) {
    const auto spread = [](Word v) LAMINA_LAMBDA { return v * 1664525u + 1013904223u; };
    Word x = spread(column), y = spread(row), z = spread(sample), w = spread(seed);
    const auto mix_all = [&] LAMINA_LAMBDA {
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
    };
    mix_all();
    x = x ^ shift_right<16>(x);
    y = y ^ shift_right<16>(y);
    z = z ^ shift_right<16>(z);
    w = w ^ shift_right<16>(w);
    mix_all();
    return w;
}

LAMINA_SIMD_END

#endif

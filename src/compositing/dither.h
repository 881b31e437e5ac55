// SPDX-License-Identifier: Apache-2.0
// Dithering along depth (LaMar 2004, section 5; docs/numerics.md, section 2). Let f be the rest of
// a value between two codes. Of P slabs, floor(P f) show the code above the value, and the others
// the code below. Twin of shaders/compositing/dither.glsl, bit for bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "compositing/codes.h"

namespace lamina {

inline constexpr int max_dither_period = 65536;

struct Dither {
    int period = 16;         // slabs after which the pattern repeats
    std::uint32_t seed = 1;  // seed of the permutation
    bool color = false;      // dithers colour codes, too, with their own permutation (seed + 1)
    int increment = 1;       // step between the two codes (section 5.2); codes are multiples of it

    friend bool operator==(const Dither&, const Dither&) = default;
};

// The order in which the slabs of a period round up: 0..period-1, shuffled with splitmix64 (Fisher
// and Yates, from the last down). Slab z from the eye has the rank [z mod period].
std::vector<std::uint32_t> dither_ranks(int period, std::uint64_t seed);

// The code of a scaled value for a rank. With an increment k > 1 codes are multiples of k, except
// for M, which stays opaque.
inline std::uint32_t dither_code(double scaled, std::uint32_t rank, int period, int increment,
                                 std::uint32_t largest) {
    const double step = increment;
    const ScaledValue value = split_scaled(scaled / step);
    const double terms = std::floor(period * value.rest + code_noise);
    const std::uint32_t steps = value.whole + (static_cast<double>(rank) < terms ? 1 : 0);
    if (scaled >= static_cast<double>(largest) - code_noise) return largest;
    return std::min(steps * static_cast<std::uint32_t>(increment), largest);
}

// The period for N slabs. The smallest opacity that a pattern can show is 1 / (M P) a slab, and a
// ray loses at most N / P codes in all by rounding down. P = N keeps this loss under one code, and
// a longer pattern would not repeat within the ray.
inline int dither_period_for(int samples) {
    return samples;
}

}  // namespace lamina

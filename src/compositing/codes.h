// SPDX-License-Identifier: Apache-2.0
#pragma once

// Codes of n bits, n = 1..16: whole numbers 0..M with M = 2^n - 1, which represent code / M. Twins
// of shaders/compositing/codes.glsl and dither.glsl, bit for bit.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/enum_words.h"
#include "lamina/emulation.h"

namespace lamina {

inline constexpr int max_code_bits = 16;

constexpr std::uint32_t largest_code(int bits) {
    return (std::uint32_t{1} << bits) - 1;
}

// Distance below a whole number at which a scaled value (M times a value in [0, 1]) counts as that
// number. Otherwise rounding errors of double precision could turn the opacity of code k into code
// k - 1.
inline constexpr double code_noise = 1e-9;

// A scaled value, split into its whole part and the rest, 0 <= rest < 1.
struct ScaledValue {
    std::uint32_t whole;
    double rest;
};

inline ScaledValue split_scaled(double scaled) {
    const double whole = std::floor(scaled + code_noise);
    return {static_cast<std::uint32_t>(whole), std::fmax(scaled - whole, 0.0)};
}

inline std::uint32_t code_nearest(double scaled) {
    return static_cast<std::uint32_t>(std::floor(scaled + 0.5));
}

// Rounds an opacity to a code. `random`: 32 random bits, used only for stochastic rounding, whose
// mean is the value.
inline std::uint32_t round_alpha(AlphaRounding rounding, const ScaledValue& scaled,
                                 std::uint32_t random) {
    switch (rounding) {
        case AlphaRounding::truncate:
            return scaled.whole;
        case AlphaRounding::nearest:
            return scaled.whole + (scaled.rest + code_noise >= 0.5 ? 1 : 0);
        case AlphaRounding::stochastic:
            return scaled.whole + (static_cast<double>(random) < scaled.rest * 0x1p32 ? 1 : 0);
    }
    unreachable_enum();
}

// Returns 32 random bits of (column, row, sample) and a seed, for stochastic rounding: the hash
// pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020. Twin of
// shaders/compositing/random_bits.glsl.
constexpr std::uint32_t random_bits(std::uint32_t column, std::uint32_t row, std::uint32_t sample,
                                    std::uint32_t seed) {
    std::uint32_t v[4] = {column, row, sample, seed};
    for (std::uint32_t& x : v) x = x * 1664525u + 1013904223u;
    const auto mix = [&v] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    mix();
    for (std::uint32_t& x : v) x ^= x >> 16;
    mix();
    return v[3];
}

// A reproducible sequence of random numbers, for permutations: splitmix64 (Steele, Lea, Flood
// 2014).
class SplitMix64 {
  public:
    explicit constexpr SplitMix64(std::uint64_t seed) : state_(seed) {}
    constexpr std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

  private:
    std::uint64_t state_;
};

inline constexpr int max_dither_period = 65536;

struct Dither {
    int period = 16;         // slabs after which the pattern repeats
    std::uint32_t seed = 1;  // seed of the permutation
    bool color = false;      // dithers colour codes, too, with their own permutation (seed + 1)
    int increment = 1;       // step between the two codes (section 5.2); codes are multiples of it

    friend bool operator==(const Dither&, const Dither&) = default;
};

// Returns the order in which the slabs of a period round up: 0..period-1, shuffled with splitmix64
// (Fisher and Yates, from the last down). Slab z from the eye has the rank [z mod period].
std::vector<std::uint32_t> dither_ranks(int period, std::uint64_t seed);

// Returns the code of a scaled value for a rank. Dithering along depth (LaMar 2004, section 5;
// docs/numerics.md, section 2): let f be the rest of a value between two codes; of P slabs, floor(P
// f) show the code above the value, and the others the code below. With an increment k > 1 codes
// are multiples of k, except for M, which stays opaque.
inline std::uint32_t dither_code(double scaled, std::uint32_t rank, int period, int increment,
                                 std::uint32_t largest) {
    const double step = increment;
    const ScaledValue value = split_scaled(scaled / step);
    const double terms = std::floor(period * value.rest + code_noise);
    const std::uint32_t steps = value.whole + (static_cast<double>(rank) < terms ? 1 : 0);
    if (scaled >= static_cast<double>(largest) - code_noise) return largest;
    return std::min(steps * static_cast<std::uint32_t>(increment), largest);
}

// Returns the period for N slabs. The smallest opacity that a pattern can show is 1 / (M P) a slab,
// and a ray loses at most N / P codes in all by rounding down. P = N keeps this loss under one
// code, and a longer pattern would not repeat within the ray.
inline int dither_period_for(int samples) {
    return samples;
}

}  // namespace lamina

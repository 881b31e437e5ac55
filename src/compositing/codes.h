// SPDX-License-Identifier: Apache-2.0
// Codes of n bits, n = 1..16: whole numbers 0..M with M = 2^n - 1, which represent code / M; and
// OVER on them (LaMar 2004, section 4; docs/numerics.md, section 2). These are twins of codes.glsl,
// dither.glsl and over.glsl in shaders/compositing, bit for bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/enum_words.h"
#include "lamina/settings.h"

namespace lamina {

inline constexpr int max_code_bits = 16;

constexpr std::uint32_t largest_code(int bits) {
    return (std::uint32_t{1} << bits) - 1;
}

// Distance below a whole number at which a scaled value (M times one in [0, 1]) still counts as it.
// Otherwise rounding errors of doubles could turn the opacity of code k into code k - 1.
inline constexpr double code_noise = 1e-9;

// A scaled value, split into a whole number and the rest, 0 <= rest < 1.
struct ScaledValue {
    std::uint32_t whole;
    double rest;
};

inline ScaledValue split_scaled(double scaled) {
    const double whole = std::floor(scaled + code_noise);
    return {static_cast<std::uint32_t>(whole), std::fmax(scaled - whole, 0.0)};
}

// Factor on a fragment's associated colour over its opacity, before it becomes a code. Colours of
// one digit lie half-way between two codes (.1 * 255 = 25.5), and the quotient is off by up to four
// roundings of float32: all of a colour's fragments then go up, in shaders and on the cpu engine.
inline constexpr float above_half_codes = 1 + 0x1p-21F;

inline std::uint32_t code_nearest(double scaled) {
    return static_cast<std::uint32_t>(std::floor(scaled + 0.5));
}

// Rounds an opacity to a code. `random`: 32 bits for stochastic rounding, whose mean is the value.
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

// Returns 32 random bits of (column, row, sample) and a seed: hash pcg4d of Jarzynski and Olano,
// "Hash Functions for GPU Rendering", JCGT 2020. Twin of shaders/compositing/random_bits.glsl.
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

// Reproducible random numbers, for permutations: splitmix64 (Steele, Lea, Flood 2014).
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

// Dithering along depth (docs/numerics.md, section 2).
struct Dither {
    int period = 16;         // slabs after which the pattern repeats
    std::uint32_t seed = 1;  // seed of the permutation
    bool color = false;      // dithers colour codes, too, with their own permutation (seed + 1)
    int increment = 1;       // codes are its multiples (LaMar 2004, section 5.2)

    friend bool operator==(const Dither&, const Dither&) = default;
};

// Returns the order in which a period's slabs round up: ranks 0..period-1, shuffled with splitmix64
// (Fisher and Yates, from the last down). Slab z from the eye has the rank at z mod period.
std::vector<std::uint32_t> dither_ranks(int period, std::uint64_t seed);

// Returns the code of a scaled value for a slab's rank. Dithering along depth (LaMar 2004, section
// 5; docs/numerics.md, section 2): with f the rest of a value between two codes, floor(P f) of P
// slabs show the code above the value, and the others the code below. With an increment k > 1 codes
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

// Returns the period P for N slabs. The smallest opacity that a pattern can show is 1 / (M P) a
// slab, and a ray loses at most N / P codes in all by rounding down. P = N keeps this loss under
// one code, and a longer pattern would not repeat within the ray.
inline int dither_period_for(int samples) {
    return samples;
}

// Returns the opacity over `share` of the length of `unit_opacity`: 1 - (1 - A)^share (LaMar 2004,
// equations 1 and 2), accurate for A in [0, 1] and share > 0 (docs/numerics.md, section 1).
inline double opacity_over(double unit_opacity, double share) {
    if (share == 1) return unit_opacity;
    return unit_opacity < 1 ? -std::expm1(share * std::log1p(-unit_opacity)) : 1.0;
}

// Returns x / M, rounded to the nearest whole number, for x <= M * M. The formula (2x + M) / (2M)
// would overflow for 16 bits. M is odd, so no quotient lies exactly between two numbers.
constexpr std::uint32_t divide_nearest(std::uint32_t x, std::uint32_t largest) {
    return (x + (largest - 1) / 2) / largest;
}

// Returns `color` with opacity `alpha` over `below`, codes 0..M; for alpha channels `color` is M.
constexpr std::uint32_t over(OverRounding rounding, std::uint32_t color, std::uint32_t alpha,
                             std::uint32_t below, std::uint32_t largest) {
    const std::uint32_t source = color * alpha, kept = below * (largest - alpha);
    return rounding == OverRounding::fused
               ? divide_nearest(source + kept, largest)
               : divide_nearest(source, largest) + divide_nearest(kept, largest);
}

// Returns the associated colour `above`, of opacity `above_alpha`, with `color` of opacity `alpha`
// behind it (front to back). separate: the source is multiplied by its opacity, rounded, attenuated
// and rounded again, as blending with (1 - destination alpha, 1) does. fused: rounded once.
constexpr std::uint32_t under(OverRounding rounding, std::uint32_t color, std::uint32_t alpha,
                              std::uint32_t above, std::uint32_t above_alpha,
                              std::uint32_t largest) {
    if (rounding == OverRounding::separate) {
        const std::uint32_t source = divide_nearest(color * alpha, largest);
        return above + divide_nearest(source * (largest - above_alpha), largest);
    }
    const std::uint64_t square = std::uint64_t{largest} * largest;
    const std::uint64_t product = std::uint64_t{color * alpha} * (largest - above_alpha);
    return above + static_cast<std::uint32_t>((product + (square - 1) / 2) / square);
}

// Computes OVER in real arithmetic on a stored code, and rounds up with a probability equal to the
// result's fraction, so the mean is right for any number of fragments. Rounding only fragments
// would not do: the blending unit rounds again (docs/numerics.md, section 8). `source`: associated,
// 0..1 like `alpha`. `random`: 32 bits. Bitwise twin of shaders/compositing/stochastic_over.glsl.
inline std::uint32_t over_stochastic(double source, double alpha, std::uint32_t below,
                                     std::uint32_t random, std::uint32_t largest) {
    const ScaledValue value = split_scaled(largest * source + below * (1 - alpha));
    const bool up = static_cast<double>(random) < value.rest * 4294967296.0;
    return std::min(value.whole + (up ? 1u : 0u), largest);
}

// Optical depth of a code of 1, which stands for opaque: a tree's node stores such codes of its
// depth in the alpha channel of a low-precision image (docs/numerics.md, section 4). encode_depth()
// and decode_depth() are twins of shaders/compositing/node_code.glsl, to float32.
inline constexpr double opaque_node_depth = 1e4;

// Returns the code in [0, 1] of optical depth S >= 0 in a node with `share` (0 < share <= 1) of its
// ray's samples. sigma = S / share is the optical depth of a whole ray filled like the node.
double encode_depth(NodeCode code, double depth, double share);

// Returns the optical depth S of a code in [0, 1].
double decode_depth(NodeCode code, double value, double share);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Codes of n bits, n = 1..16: whole numbers 0..M with M = 2^n - 1, which represent code / M. Twin
// of shaders/compositing/codes.glsl, bit for bit.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/enum_words.h"
#include "lamina/emulation.h"

namespace lamina {

inline constexpr int max_code_bits = 16;

constexpr std::uint32_t largest_code(int bits) {
    return (std::uint32_t{1} << bits) - 1;
}

// A scaled value (M times a value in [0, 1]) that is this little below a whole number counts as
// that number. Otherwise rounding errors of double precision could turn the opacity of code k into
// code k - 1.
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

// Rounds an opacity to a code. `random`: 32 random bits, used for stochastic rounding only, whose
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

}  // namespace lamina

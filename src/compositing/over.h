// SPDX-License-Identifier: Apache-2.0
#pragma once

// The OVER operator on n-bit codes (LaMar 2004, section 4; docs/numerics.md, section 2). Twin of
// shaders/compositing/over.glsl, bit for bit. M is odd, so no quotient lies exactly between two
// codes.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compositing/codes.h"
#include "lamina/emulation.h"

namespace lamina {

// Returns the opacity over `share` of the length that `unit_opacity` refers to: 1 - (1 - A)^share
// (LaMar 2004, equations 1 and 2). It is accurate to rounding for every A in [0, 1] and share > 0
// (docs/numerics.md, section 1).
inline double opacity_over(double unit_opacity, double share) {
    if (share == 1) return unit_opacity;
    return unit_opacity < 1 ? -std::expm1(share * std::log1p(-unit_opacity)) : 1.0;
}

// Returns x / M, rounded to the nearest whole number, for x <= M * M. The formula (2x + M) / (2M)
// would overflow for 16 bits.
constexpr std::uint32_t divide_nearest(std::uint32_t x, std::uint32_t largest) {
    return (x + (largest - 1) / 2) / largest;
}

// Returns colour `color` with opacity `alpha` over `below`, all codes 0..M; for the alpha channel
// `color` is M.
constexpr std::uint32_t over(OverRounding rounding, std::uint32_t color, std::uint32_t alpha,
                             std::uint32_t below, std::uint32_t largest) {
    const std::uint32_t source = color * alpha, kept = below * (largest - alpha);
    return rounding == OverRounding::fused
               ? divide_nearest(source + kept, largest)
               : divide_nearest(source, largest) + divide_nearest(kept, largest);
}

// Composites front to back: adds `color` with opacity `alpha` behind the associated colour `above`
// with opacity `above_alpha`. separate: the source is multiplied by its opacity, rounded,
// attenuated and rounded again, as blending with (1 - destination alpha, 1) does. fused: there is
// one rounding.
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

// Computes OVER in real arithmetic on a stored code, and rounds up with the probability of the
// result's rest. This is unbiased for any number of fragments. Rounding the fragment alone at
// random is biased, because the blend rounds again (docs/numerics.md, section 8). `source`:
// associated and in [0, 1], like `alpha`. `random`: 32 random bits. Twin of
// shaders/compositing/stochastic_over.glsl, bit for bit.
inline std::uint32_t over_stochastic(double source, double alpha, std::uint32_t below,
                                     std::uint32_t random, std::uint32_t largest) {
    const ScaledValue value = split_scaled(largest * source + below * (1 - alpha));
    const bool up = static_cast<double>(random) < value.rest * 4294967296.0;
    return std::min(value.whole + (up ? 1u : 0u), largest);
}

}  // namespace lamina

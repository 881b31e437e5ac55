// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// Rounding of an opacity to a code (LaMar 2004, section 4.1: the paper's hardware truncates).
enum class AlphaRounding { truncate, nearest, stochastic };

// Rounding of OVER. separate: each of the two products is rounded, as by the paper's hardware.
// fused: only their sum is rounded.
enum class OverRounding { separate, fused };

// Fixed-point compositing that is computed step by step, not by a blending unit (render.emulate).
struct Emulation {
    int bits = 8;
    AlphaRounding alpha = AlphaRounding::truncate;
    OverRounding over = OverRounding::separate;
    std::uint32_t seed = 1;  // of the random numbers of stochastic rounding

    friend bool operator==(const Emulation&, const Emulation&) = default;
};

}  // namespace lamina

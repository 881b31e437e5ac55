// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "compositing/codes.h"

namespace lamina {

// OVER in real arithmetic on a stored code, its result rounded up with the probability of its rest:
// unbiased however many fragments follow, where rounding the fragment alone is not, because the
// blend rounds again (docs/numerics.md, section 8). `source`: associated, in [0, 1], like `alpha`;
// `random`: 32 random bits. Twin of shaders/compositing/stochastic_over.glsl, bit for bit.
inline std::uint32_t over_stochastic(double source, double alpha, std::uint32_t below,
                                     std::uint32_t random, std::uint32_t largest) {
    const ScaledValue value = split_scaled(largest * source + below * (1 - alpha));
    const bool up = static_cast<double>(random) < value.rest * 4294967296.0;
    return std::min(value.whole + (up ? 1u : 0u), largest);
}

}  // namespace lamina

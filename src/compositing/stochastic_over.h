// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "compositing/codes.h"

namespace lamina {

// OVER in real arithmetic on a stored code. The result is rounded up with the probability of its
// rest. This is unbiased for any number of fragments. Rounding the fragment alone at random is
// biased, because the blend rounds again (docs/numerics.md, section 8). `source`: associated and in
// [0, 1], like `alpha`. `random`: 32 random bits. Twin of shaders/compositing/stochastic_over.glsl,
// bit for bit.
inline std::uint32_t over_stochastic(double source, double alpha, std::uint32_t below,
                                     std::uint32_t random, std::uint32_t largest) {
    const ScaledValue value = split_scaled(largest * source + below * (1 - alpha));
    const bool up = static_cast<double>(random) < value.rest * 4294967296.0;
    return std::min(value.whole + (up ? 1u : 0u), largest);
}

}  // namespace lamina

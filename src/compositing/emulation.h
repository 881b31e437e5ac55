// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "compositing/codes.h"
#include "compositing/over.h"

namespace lamina {

// Fixed-point compositing computed step by step instead of by a blending unit (render.emulate).
struct Emulation {
    int bits = 8;
    AlphaRounding alpha = AlphaRounding::truncate;
    OverRounding over = OverRounding::separate;
    std::uint32_t seed = 1;  // of stochastic rounding

    friend bool operator==(const Emulation&, const Emulation&) = default;
};

}  // namespace lamina

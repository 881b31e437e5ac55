// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "lamina/lighting.h"

namespace lamina {

// The smallest gradient of a lighting that has one, as mantissa * 2^exponent. It may be smaller or
// larger than all numbers of float32.
struct SmallestGradient {
    float mantissa = 1;  // 1 to 2
    int exponent = 0;
};

inline SmallestGradient smallest_gradient_of(const Lighting& lighting) {
    const int exponent = std::ilogb(*lighting.smallest_gradient);
    return {static_cast<float>(std::ldexp(*lighting.smallest_gradient, -exponent)), exponent};
}

}  // namespace lamina

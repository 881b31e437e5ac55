// SPDX-License-Identifier: Apache-2.0
#include "image/srgb.h"

#include <algorithm>
#include <cmath>

namespace lamina {

double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

std::uint16_t display_code(double value, ImageColorSpace space) {
    const double shown = std::clamp(value, 0.0, 1.0);
    const double stored = space == ImageColorSpace::display ? shown : srgb_from_linear(shown);
    return static_cast<std::uint16_t>(std::lround(255 * stored));
}

}  // namespace lamina

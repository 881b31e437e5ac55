// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/image_color_space.h"

namespace lamina {

// The transfer curve of sRGB (IEC 61966-2-1), from linear light 0..1 to the stored value 0..1, and
// back. Callers must clamp arguments to 0..1.
double srgb_from_linear(double linear);
double linear_from_srgb(double stored);

// Returns the 8-bit code that shows a number of a picture, linear light or a display value, clamped
// to 0..1.
std::uint16_t display_code(double value, ImageColorSpace space);

}  // namespace lamina

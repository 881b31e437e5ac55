// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "image/coded_image.h"
#include "image/difference.h"

namespace lamina {

// A picture of a signed difference in 8-bit sRGB codes. It shows the channel with the largest |e|
// of each pixel: blue where e < 0, white at 0, red where e > 0, darkest where |e| >= scale (in
// 1/255). With scale 0 all pixels with e = 0 are white.
CodedImage false_color(const Difference& difference, double scale);

// Its colour of e = share * scale, for -1 <= share <= 1: sRGB codes.
std::array<std::uint16_t, 3> false_color_of(double share);

// false_color() of a difference, pixel by pixel from the top left, and below it the colour bar from
// -scale to scale with its ends in figures. Where differences beyond it are shown as dark as these,
// the ends say so ("<=", ">="). White fills up what is narrower than the bar.
CodedImage difference_picture(const Difference& difference, double scale);

}  // namespace lamina

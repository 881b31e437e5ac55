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

// Returns the colour, in sRGB codes, of e = share * scale, for -1 <= share <= 1.
std::array<std::uint16_t, 3> false_color_of(double share);

// Draws false_color() of a difference and below it the colour bar from -scale to scale with the
// numbers at its ends. If differences beyond the scale are clipped, the ends say so ("<=", ">=").
// White fills up pictures that are narrower than the bar.
CodedImage difference_picture(const Difference& difference, double scale);

}  // namespace lamina

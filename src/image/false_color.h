// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "image/difference.h"

namespace lamina {

// A picture of a signed difference in 8-bit sRGB codes. It shows the channel with the largest |e|
// of each pixel: blue where e < 0, white at 0, red where e > 0, darkest where |e| >= scale (in
// 1/255). With scale 0 all pixels with e = 0 are white.
CodedImage false_color(const Difference& difference, double scale);

}  // namespace lamina

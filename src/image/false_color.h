// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "image/difference.h"

namespace lamina {

// A signed difference to look at: of each pixel the channel with the largest |e|, blue where e < 0,
// white at 0, red where e > 0, darkest at |e| >= scale (in 1/255). scale 0: white wherever e = 0.
// 8-bit sRGB codes.
CodedImage false_color(const Difference& difference, double scale);

}  // namespace lamina

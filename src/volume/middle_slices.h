// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Draws the three slices through the middle sample side by side on white, axes and index of each
// above it: (x right, y up), (x right, z up), (y right, z up), in lengths of the world. The longest
// axis has 256 to 1024 pixels, if possible a whole number a sample; pixels show the nearest sample.
// Grey goes from range.lo (black) to range.hi (white), 0.5 if equal. Non-finite samples are blue.
CodedImage middle_slices(const Volume& volume, const ValueRange& range);

}  // namespace lamina

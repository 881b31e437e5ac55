// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The three slices through the middle sample, side by side with gaps: (x right, y up), (x right, z
// up), (y right, z up). A sample is one pixel. Grey goes from `range.lo` (black) to `range.hi`
// (white), and is 0.5 where both are the same. Samples that are not finite and the gaps are blue.
// Throws Error where the picture would exceed the limits of images.
CodedImage middle_slices(const Volume& volume, const ValueRange& range);

}  // namespace lamina

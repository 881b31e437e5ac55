// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The three slices through the middle sample, side by side with room between: (x right, y up), (x
// right, z up), (y right, z up). One pixel a sample; grey from `range.lo` (black) to `range.hi`
// (white), 0.5 where they are one value; samples that are not finite, and the room between, are
// blue. Throws Error where that is larger than an image may be.
CodedImage middle_slices(const Volume& volume, const ValueRange& range);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Draws the three slices through the middle sample side by side on white, each with its axes and
// the index of the slice above: (x right, y up), (x right, z up), (y right, z up), in lengths of
// the world. The longest axis has 256 to 1024 pixels, if possible a whole number for each sample;
// a pixel shows the nearest sample. Grey goes from `range.lo` (black) to `range.hi` (white), and is
// 0.5 if both are the same. Samples that are not finite are blue.
CodedImage middle_slices(const Volume& volume, const ValueRange& range);

}  // namespace lamina

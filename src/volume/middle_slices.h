// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Draws the three slices through the middle sample side by side on white, each with its axes and
// the index of the slice above: (x right, y up), (x right, z up), (y right, z up). Lengths are
// those of the world: a sample along the axis of the smallest spacing is one pixel; or a whole
// number of pixels if the longest axis would be shorter than 256 pixels; or less than one if it
// would be longer than 1024. A pixel shows the sample that is nearest to its centre. Grey goes from
// `range.lo` (black) to `range.hi` (white), and is 0.5 if both are the same. Samples that are not
// finite are blue.
CodedImage middle_slices(const Volume& volume, const ValueRange& range);

}  // namespace lamina

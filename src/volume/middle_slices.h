// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Draws the three slices through the middle sample side by side on white: xy, xz and yz (the first
// axis points right, the second up). A title above each names its axes and index. Lengths are to
// scale in world space; the longest axis has 256 to 1024 pixels. A pixel shows the nearest sample:
// grey from range.lo (black) to range.hi (white), mid-grey if both are equal, blue if not finite.
CodedImage middle_slices(const Volume& volume, const ValueRange& range);

}  // namespace lamina

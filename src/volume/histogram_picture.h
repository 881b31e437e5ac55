// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "volume/value_statistics.h"

namespace lamina {

// The histogram as a picture with white paper: a bar an interval, as high as the logarithm of 1 +
// its count, the range of values below, and marks at the median and the outermost percentiles.
// `width`: 200 pixels or more. An empty histogram is a line that says so.
CodedImage histogram_picture(const ValueStatistics& statistics, int width);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/value_distribution.h"
#include "lamina/value_histogram.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Counts the values in at most `bins` >= 1 intervals over `range`, which holds them all. Intervals
// of whole numbers hold equally many of them, so that none looks rarer than it is; the first is
// centred so that the lowest is in the middle of its first unit. `values` may be empty.
ValueHistogram binned(const ValueDistribution& values, const ValueRange& range, bool whole_numbers,
                      int bins);

}  // namespace lamina

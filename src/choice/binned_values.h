// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/value_distribution.h"
#include "lamina/value_histogram.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Counts the values in at most `bins` >= 1 intervals over `range`, in which they all lie. Of whole
// numbers each interval has equally many, so that none looks rarer than it is, and the first
// interval has the lowest in its first unit's middle. `values` may be empty.
ValueHistogram binned(const ValueDistribution& values, const ValueRange& range, bool whole_numbers,
                      int bins);

}  // namespace lamina

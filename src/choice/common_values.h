// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/value_distribution.h"

namespace lamina {

// The values that most of a field has, from lo to hi: air around a scanned object, the undisturbed
// flow, the vacuum between molecules.
struct CommonValues {
    double lo = 0, hi = 0;
    // True: they stand out as a narrow peak, beyond which values are rare. False: values gather
    // nowhere, and these are just the closest together.
    bool background = false;
};

// Finds the common values of a distribution of two or more values. `whole_numbers`: all values are
// whole.
CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers);

// The range without the outermost thousandth of values at each end, if these take up most of the
// range: a few extreme values would leave no room for all others.
struct UsualRange {
    double lo = 0, hi = 0;
};
UsualRange usual_range(const ValueDistribution& values);

}  // namespace lamina

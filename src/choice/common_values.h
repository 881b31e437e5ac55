// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/value_distribution.h"

namespace lamina {

// The values that most of a field has, from lo to hi: air around what was scanned, the undisturbed
// flow, the vacuum between molecules.
struct CommonValues {
    double lo = 0, hi = 0;
    // They stand out: a narrow peak, beyond which values are rare. Else they are only the closest
    // together of a field whose values gather nowhere.
    bool background = false;
};

// Looks for them. The distribution has two or more values. `whole_numbers`: they are all of them.
CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers);

// The range of values without the outermost thousandth at each end, where that holds most of the
// range: a few extreme values would leave no room for all others.
struct UsualRange {
    double lo = 0, hi = 0;
};
UsualRange usual_range(const ValueDistribution& values);

}  // namespace lamina

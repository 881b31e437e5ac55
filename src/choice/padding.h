// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "choice/value_distribution.h"

namespace lamina {

// Values that stand for "nothing was measured here", such as -3024 around the round picture of a
// CT, or -9999 on land in a model of the sea.
struct Padding {
    std::vector<double> values;
    double share = 0;        // of the field
    ValueDistribution rest;  // all other values
    // Close to the rest, on its way to the padding below it and above it, where there is one.
    std::optional<double> below, above;
};

// Finds single values that are far from all others, at both ends (docs/first-picture.md).
// `whole_numbers`: they are all of them.
Padding find_padding(const ValueDistribution& all, bool whole_numbers);

}  // namespace lamina

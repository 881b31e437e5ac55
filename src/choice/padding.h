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
    double share = 0;                    // of the field
    ValueDistribution rest;              // all other values
    std::optional<double> below, above;  // those next to the rest, where there are any

    // Between the padding and the rest, close to the rest: what interpolates between the two shows
    // up to there alone.
    double edge_below() const;
    double edge_above() const;
    // Whether cells that interpolate between padding and rest would show the rest's values up to
    // `lo`, or from `hi` on, as a shell around the rest that is not thin.
    bool shell_below(double lo) const;
    bool shell_above(double hi) const;
};

// Share of a volume that a value has to take to be padding: fewer samples may be noise.
inline constexpr double least_padding = 1e-3;

// Finds single values that are far from all others, at both ends (docs/first-picture.md).
// `whole_numbers`: they are all of them. `least_share`: a value that takes less of the field is no
// padding. Below `least_padding` only values farther away than the whole range of the rest are.
Padding find_padding(const ValueDistribution& all, bool whole_numbers,
                     double least_share = least_padding);

// Returns the values, however rare, that are farther from all others than these are apart, as far
// as padding has to be.
std::vector<double> find_markers(const ValueDistribution& all);

}  // namespace lamina

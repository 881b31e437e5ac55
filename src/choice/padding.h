// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "choice/value_distribution.h"

namespace lamina {

// Values that mean "nothing was measured here", such as -3024 around the round picture of a CT, or
// -9999 on land in a model of the sea.
struct Padding {
    std::vector<double> values;
    double share = 0;                    // of the field
    ValueDistribution rest;              // all other values
    std::optional<double> below, above;  // the padding values next to the rest, if there are any

    // Returns a value between the padding and the rest, close to the rest. Values interpolated
    // between padding and rest are visible only on the rest's side of it.
    double edge_below() const;
    double edge_above() const;
    // Tells whether cells between padding and rest would show the rest's values up to `lo`, or from
    // `hi` on, as a thick shell around the rest.
    bool shell_below(double lo) const;
    bool shell_above(double hi) const;
};

// Share of a volume that a value must have to be padding: fewer samples may be noise.
inline constexpr double least_padding = 1e-3;

// Finds single values that are far from all others, at both ends (docs/first-picture.md).
// `whole_numbers`: all values are whole. `least_share`: a value with less of the field is no
// padding. Values with less than `least_padding` must be farther away than the whole range of the
// rest.
Padding find_padding(const ValueDistribution& all, bool whole_numbers,
                     double least_share = least_padding);

// Returns the values, however rare, that are farther from all others than these are from each
// other, by the distance that padding requires.
std::vector<double> find_markers(const ValueDistribution& all);

}  // namespace lamina

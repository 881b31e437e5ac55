// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "choice/variation.h"
#include "lamina/report.h"

namespace lamina {

// A kind of thing in the data: a hump of the histogram, or what lies beyond the last one.
struct Material {
    double boundary = 0;  // value from which on it shows: that of its surface
    double center = 0;    // its most frequent value
    double share = 0;     // of the field
};

// The background and what lies above it in value.
struct Materials {
    double background = 0;            // most frequent value of the background
    std::vector<Material> materials;  // ascending; none if the field has no humps: it is smooth
};

inline constexpr std::size_t most_materials = 4;

// Finds materials. `histogram` has the variation's bins; `spacing`: world distance between
// neighbouring places. The background is the lowest hump; the result is empty if it holds less than
// a fifth of the field (docs/first-picture.md).
Materials find_materials(const ValueHistogram& histogram, const Variation& variation,
                         double spacing);

}  // namespace lamina

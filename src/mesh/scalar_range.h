// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "lamina/tet.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The values of a scalar of a mesh.
struct ScalarRange {
    ValueRange range;             // range of the finite values
    std::int64_t non_finite = 0;  // number of NaN or infinite values
};

// The range of a tet's corners; empty where one of them is not finite.
inline ValueRange range_in(std::span<const double> values, const Tet& tet) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ValueRange range{infinity, -infinity};
    for (const std::int32_t corner : tet) {
        const double value = values[static_cast<std::size_t>(corner)];
        if (!std::isfinite(value)) return {infinity, -infinity};
        range.lo = std::min(range.lo, value);
        range.hi = std::max(range.hi, value);
    }
    return range;
}

inline ScalarRange measure_range(std::span<const double> values) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ScalarRange found{{infinity, -infinity}, 0};
    for (const double value : values) {
        if (!std::isfinite(value)) {
            ++found.non_finite;
            continue;
        }
        found.range.lo = std::min(found.range.lo, value);
        found.range.hi = std::max(found.range.hi, value);
    }
    return found;
}

}  // namespace lamina

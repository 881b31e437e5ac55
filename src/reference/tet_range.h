// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "lamina/tet.h"

namespace lamina {

struct TetRange {
    double least, most;
};

// The range of the values at a tet's corners. `values`: one a point.
inline TetRange range_of(const Tet& tet, std::span<const double> values) {
    const auto value = [&](std::size_t i) { return values[static_cast<std::size_t>(tet[i])]; };
    const auto [least, most] = std::minmax({value(0), value(1), value(2), value(3)});
    return {least, most};
}

}  // namespace lamina

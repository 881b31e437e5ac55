// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace lamina {

// Keeps the part of a convex polygon where height(corner), a linear function, is >= 0 (Sutherland
// and Hodgman, Reentrant polygon clipping, 1974). A Polygon has corners, their count, and add().
template <typename Polygon, typename Height>
Polygon cut(const Polygon& polygon, const Height& height) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const auto& a = polygon.corners[i];
        const auto& b = polygon.corners[(i + 1) % polygon.count];
        const double at_a = height(a), at_b = height(b);
        if (at_a >= 0) kept.add(a);
        if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
            kept.add(a + (at_a / (at_a - at_b)) * (b - a));
    }
    return kept;
}

}  // namespace lamina

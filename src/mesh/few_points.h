// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace lamina {

// A list of up to `most` points; points beyond that number are dropped.
template <typename Point, std::size_t most>
struct FewPoints {
    std::size_t count = 0;
    std::array<Point, most> corners;

    void add(const Point& point) {
        if (count < most) corners[count++] = point;
    }
    std::span<const Point> points() const { return {corners.data(), count}; }
};

// Returns the part of a convex polygon (FewPoints) in which height(), a linear function of the
// place, is >= 0 (Sutherland and Hodgman, Reentrant polygon clipping, 1974).
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

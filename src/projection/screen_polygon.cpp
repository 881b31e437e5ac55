// SPDX-License-Identifier: Apache-2.0
#include "projection/screen_polygon.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/camera.h"

namespace lamina {
namespace {

constexpr std::size_t most_points = 8;  // that surround() takes

// Polygons are cut off this far from the picture, so that rasterisers keep sub-pixel digits.
constexpr double picture_margin = 2;  // pixels

// Distance below which two corners count as one.
constexpr double coincident = 1e-9;  // pixels

// Corners are cut off square if the directions of their edges have a cosine c below this. Corners
// of the enlarged polygon thus stick out by at most 1 / sqrt((1 + c) / 2) margins.
constexpr double sharpest = -0.96;

bool are_same(const glm::dvec2& a, const glm::dvec2& b) {
    return glm::dot(a - b, a - b) < coincident * coincident;
}

using Hull = FewPoints<glm::dvec2, most_points + 5>;

// Returns the convex hull, counter-clockwise, by Andrew's monotone chain. No corner is straight.
Hull convex_hull(std::span<const glm::dvec2> points) {
    std::array<glm::dvec2, most_points> sorted;
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {  // insertion sort
        std::size_t place = i;
        const auto before = [&](const glm::dvec2& other) {
            return points[i].x != other.x ? points[i].x < other.x : points[i].y < other.y;
        };
        for (; place > 0 && before(sorted[place - 1]); --place) sorted[place] = sorted[place - 1];
        sorted[place] = points[i];
    }
    std::array<glm::dvec2, 2 * most_points> chain;
    std::size_t top = 0;
    const auto add = [&](const glm::dvec2& point, std::size_t floor) {
        while (top >= floor + 2 &&
               cross(chain[top - 1] - chain[top - 2], point - chain[top - 1]) <= 0)
            --top;
        chain[top++] = point;
    };
    for (std::size_t i = 0; i < count; ++i) add(sorted[i], 0);
    const std::size_t floor = top - 1;
    for (std::size_t i = count - 1; i-- > 0;) add(sorted[i], floor);
    Hull hull;
    for (std::size_t i = 0; i + 1 < top; ++i) {
        const bool repeated = hull.count > 0 && are_same(chain[i], hull.corners[hull.count - 1]);
        if (!repeated) hull.add(chain[i]);
    }
    while (hull.count > 1 && are_same(hull.corners[0], hull.corners[hull.count - 1])) --hull.count;
    if (hull.count == 0) hull.add(chain[0]);
    return hull;
}

struct Bounds {
    glm::dvec2 min, max;
};

Bounds bounds_of(std::span<const glm::dvec2> points, double margin) {
    Bounds bounds{points[0], points[0]};
    for (const glm::dvec2& point : points) {
        bounds.min = glm::min(bounds.min, point);
        bounds.max = glm::max(bounds.max, point);
    }
    return {bounds.min - margin, bounds.max + margin};
}

ScreenPolygon rectangle(const Bounds& bounds, double step) {
    const glm::vec2 lo(glm::floor(bounds.min / step) * step);
    const glm::vec2 hi(glm::ceil(bounds.max / step) * step);
    return {4, {lo, glm::vec2(hi.x, lo.y), hi, glm::vec2(lo.x, hi.y)}};
}

bool is_convex(const Hull& hull) {
    for (std::size_t i = 0; i < hull.count; ++i) {
        const glm::dvec2& a = hull.corners[i];
        const glm::dvec2& b = hull.corners[(i + 1) % hull.count];
        const glm::dvec2& c = hull.corners[(i + 2) % hull.count];
        if (cross(b - a, c - b) <= 0) return false;
    }
    return true;
}

// Moves the hull's edges outwards by `margin`. The corners lie on a grid of half of `margin`, on
// which coordinates and cross products are exact.
ScreenPolygon enlarged(const Hull& hull, double margin) {
    const double step = margin / 2;
    Hull larger;
    const auto add = [&](const glm::dvec2& corner) {
        larger.add(glm::floor(corner / step + 0.5) * step);
    };
    glm::dvec2 in = glm::normalize(hull.corners[0] - hull.corners[hull.count - 1]);
    for (std::size_t i = 0; i < hull.count; ++i) {
        const glm::dvec2& corner = hull.corners[i];
        const glm::dvec2 out = glm::normalize(hull.corners[(i + 1) % hull.count] - corner);
        const glm::dvec2 normal_in(in.y, -in.x), normal_out(out.y, -out.x);
        const double cosine = glm::dot(in, out);
        if (cosine > sharpest) {
            add(corner + margin / (1 + cosine) * (normal_in + normal_out));
        } else {
            add(corner + margin * (normal_in + in));
            add(corner + margin * (normal_out - out));
        }
        in = out;
    }
    if (!is_convex(larger)) larger = convex_hull(larger.points());
    ScreenPolygon polygon;
    for (const glm::dvec2& corner : larger.points())
        polygon.corners[static_cast<std::size_t>(polygon.count++)] = glm::vec2(corner);
    return polygon;
}

}  // namespace

PixelBounds pixel_bounds(std::span<const glm::dvec2> points, double margin, int width, int height) {
    const Bounds bounds = bounds_of(points, margin);
    const glm::dvec2 first = glm::max(glm::ceil(bounds.min - 0.5), glm::dvec2(0));
    const glm::dvec2 last =
        glm::min(glm::floor(bounds.max - 0.5), glm::dvec2(width - 1, height - 1));
    if (!(first.x <= last.x && first.y <= last.y)) return {};
    return {static_cast<int>(first.x), static_cast<int>(last.x), static_cast<int>(first.y),
            static_cast<int>(last.y)};
}

ScreenPolygon surround(std::span<const glm::dvec2> points, double margin, int width, int height) {
    assert(!points.empty() && points.size() <= most_points);
    const Bounds bounds = bounds_of(points, margin);
    if (pixel_bounds(points, margin, width, height).empty()) return {};
    Hull hull = convex_hull(points);
    const glm::dvec2 lo(-picture_margin), hi(width + picture_margin, height + picture_margin);
    for (const int axis : {0, 1}) {
        if (bounds.min[axis] < lo[axis])
            hull = cut(hull, [&](const glm::dvec2& p) { return p[axis] - lo[axis]; });
        if (bounds.max[axis] > hi[axis])
            hull = cut(hull, [&](const glm::dvec2& p) { return hi[axis] - p[axis]; });
    }
    if (hull.count == 0) return {};
    // A rectangle may cover more than the tet: fragments beside the tet find segments of length 0.
    if (hull.count == 1 || hull.count > 6)
        return rectangle(bounds_of(hull.points(), margin), margin / 2);
    return enlarged(hull, margin);
}

}  // namespace lamina

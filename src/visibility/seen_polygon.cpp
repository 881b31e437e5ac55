// SPDX-License-Identifier: Apache-2.0
#include "visibility/seen_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "visibility/polygon_cut.h"

namespace lamina {
namespace {

// Pixels count as covered if their centre lies so near to the polygon, in pixels. It is more than
// what rounding moves a corner by (coordinates up to 1e9 pixels, beside the near plane, are good to
// 1e-7), and more than the ray perturbation (1e-7).
constexpr double margin = 1e-3;

double signed_area(const SeenPolygon& polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
        sum += cross(polygon.corners[i - 1] - polygon.corners[0],
                     polygon.corners[i] - polygon.corners[0]);
    }
    return 0.5 * sum;
}

// A range of columns or of rows, clamped to what a picture can have.
struct Range {
    double low = INFINITY, high = -INFINITY;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    std::int32_t first(std::int32_t least) const {
        return static_cast<std::int32_t>(
            std::clamp(std::ceil(low - margin), static_cast<double>(least), 0x1p30));
    }
    std::int32_t last(std::int32_t most) const {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(high + margin), -0x1p30, static_cast<double>(most)));
    }
};

// The columns of a polygon between two rows.
Range columns_between(const SeenPolygon& polygon, double top, double bottom) {
    Range columns;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& a = polygon.corners[i];
        const glm::dvec2& b = polygon.corners[(i + 1) % polygon.count];
        if (a.y >= top && a.y <= bottom) columns.add(a.x);
        for (const double row : {top, bottom}) {
            if ((a.y < row) == (b.y < row)) continue;
            columns.add(a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x));
        }
    }
    return columns;
}

// Calls visit(pixels) for each row of the area in which the polygon covers some, until it returns
// false.
template <typename Visit>
void for_each_row(const SeenPolygon& polygon, const PixelArea& area, const Visit& visit) {
    Range rows;
    for (std::size_t i = 0; i < polygon.count; ++i) rows.add(polygon.corners[i].y);
    const std::int32_t last = rows.last(area.last_row);
    for (std::int32_t row = rows.first(area.first_row); row <= last; ++row) {
        const Range columns = columns_between(polygon, row - margin, row + margin);
        const PixelArea pixels{columns.first(area.first_column), columns.last(area.last_column),
                               row, row};
        if (!pixels.empty() && !visit(pixels)) return;
    }
}

}  // namespace

double SeenPolygon::area() const {
    return std::abs(signed_area(*this));
}

glm::dvec2 PixelFinder::place_of(const glm::dvec3& seen) const {
    const glm::dvec2 window = window_.to_window(seen);
    return {window.x - 0.5, window_.view().height - 0.5 - window.y};
}

SeenPolygon PixelFinder::polygon(const Triangle& triangle) const {
    SeenPolygon seen;
    const std::array<glm::dvec3, 3> corners{window_.see(triangle[0]), window_.see(triangle[1]),
                                            window_.see(triangle[2])};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
        if (!window_.perspective() || a.z >= near_) seen.add(place_of(a));
        if (window_.perspective() && (a.z < near_) != (b.z < near_)) {
            glm::dvec3 at = a + (near_ - a.z) / (b.z - a.z) * (b - a);
            at.z = near_;
            seen.add(place_of(at));
        }
    }
    return seen;
}

PixelArea PixelFinder::pixels_of(std::span<const glm::dvec3> points) const {
    const PixelArea all{0, window_.view().width - 1, 0, window_.view().height - 1};
    Range columns, rows;
    std::size_t hidden = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 seen = window_.see(point);
        if (window_.perspective() && seen.z < near_) {
            ++hidden;
            continue;
        }
        const glm::dvec2 place = place_of(seen);
        columns.add(place.x);
        rows.add(place.y);
    }
    if (hidden == points.size()) return {0, -1, 0, -1};
    if (hidden > 0) return all;
    return {columns.first(0), columns.last(all.last_column), rows.first(0),
            rows.last(all.last_row)};
}

SeenPolygon overlap_of(const SeenPolygon& a, const SeenPolygon& b) {
    const double sign = signed_area(b) < 0 ? -1 : 1;
    SeenPolygon common = a;
    for (std::size_t i = 0; i < b.count; ++i) {
        const glm::dvec2& from = b.corners[i];
        const glm::dvec2 along = b.corners[(i + 1) % b.count] - from;
        common = cut(common, [&](const glm::dvec2& c) { return sign * cross(along, c - from); });
    }
    return common;
}

PixelArea covered_pixels(const SeenPolygon& polygon, const PixelArea& area) {
    PixelArea covered{0, -1, 0, -1};
    for_each_row(polygon, area, [&](const PixelArea& pixels) {
        covered.add(pixels);
        return true;
    });
    return covered;
}

bool covers_some(const SeenPolygon& polygon, const PixelArea& area) {
    bool some = false;
    for_each_row(polygon, area, [&](const PixelArea&) {
        some = true;
        return false;
    });
    return some;
}

}  // namespace lamina

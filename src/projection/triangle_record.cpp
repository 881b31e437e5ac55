// SPDX-License-Identifier: Apache-2.0
#include "projection/triangle_record.h"

#include <cmath>

#include "scene/camera.h"

namespace lamina {
namespace {

constexpr double grid_steps = 4096;  // steps a pixel, sixteen times as many as in most rasterisers

// An edge starts at its lesser corner, so that both of its triangles compute the same numbers. The
// top-left rule of rasterisers whose rows run upwards decides: a point on an edge belongs to the
// triangle to the right, on horizontal edges to the one above.
TriangleRecord::Edge edge_of(glm::dvec2 a, glm::dvec2 b, const glm::dvec2& inside) {
    if (b.x < a.x || (b.x == a.x && b.y < a.y)) std::swap(a, b);
    const glm::dvec2 along = b - a;
    const bool left = cross(along, inside - a) > 0;
    const double sign = left ? 1 : -1;
    return {a.x, a.y, -sign * along.y, sign * along.x, along.y > 0 ? !left : left};
}

// `area` is twice the triangle's area, and may be negative.
TriangleRecord::Share share_of(const glm::dvec2& a, const glm::dvec2& b, double area) {
    const glm::dvec2 along = (b - a) / area;
    return {a.x, a.y, -along.y, along.x};
}

}  // namespace

// The result is exact up to 2^44 pixels, so that edge functions below are exact up to 2^17.
glm::dvec2 rounded_to_grid(const glm::vec2& window) {
    const auto rounded = [](float v) {
        return std::floor(static_cast<double>(v) * grid_steps + 0.5) / grid_steps;
    };
    return {rounded(window.x), rounded(window.y)};
}

bool make_triangle(const std::array<const FanVertex*, 3>& vertices, TriangleRecord& record) {
    std::array<glm::dvec2, 3> places, exact;
    for (std::size_t i = 0; i < 3; ++i) {
        places[i] = rounded_to_grid(vertices[i]->position);
        exact[i] = glm::dvec2(vertices[i]->position);
    }
    const auto area_of = [](const std::array<glm::dvec2, 3>& p) {
        return cross(p[1] - p[0], p[2] - p[0]);
    };
    const double rounded_area = area_of(places);
    if (!(std::abs(rounded_area) > 0) || !std::isfinite(rounded_area)) return false;
    // Rounding widens slivers and may turn them over. Far outside their exact corners nothing can
    // be interpolated, so interpolation is between the rounded corners.
    const bool is_sliver = area_of(exact) * rounded_area <= 0.01 * rounded_area * rounded_area;
    const std::array<glm::dvec2, 3>& between = is_sliver ? places : exact;
    const double area = area_of(between);
    for (std::size_t i = 0; i < 3; ++i) {
        record.edges[i] = edge_of(places[(i + 1) % 3], places[(i + 2) % 3], places[i]);
        record.shares[i] = share_of(between[(i + 1) % 3], between[(i + 2) % 3], area);
        record.corners[i] = {vertices[i]->inverse, vertices[i]->front, vertices[i]->back};
    }
    record.scalars = vertices[0]->scalars;
    record.number = vertices[0]->tet;
    return true;
}

}  // namespace lamina

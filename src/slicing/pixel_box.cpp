// SPDX-License-Identifier: Apache-2.0
#include "slicing/pixel_box.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace lamina {
namespace {

// Margin for the roundings of rays and boxes to float, which are far smaller.
constexpr double margin_pixels = 1;

// Share of the farthest corner's depth: corners nearer to the eye's plane count as behind it.
constexpr double nearest_share = 1e-6;

int clamped(double place, int size) {
    return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(size)));
}

}  // namespace

PixelBox PixelBox::joined(const PixelBox& other) const {
    return {std::min(first_column, other.first_column), std::max(end_column, other.end_column),
            std::min(first_row, other.first_row), std::max(end_row, other.end_row)};
}

PixelBox PixelBox::common(const PixelBox& other) const {
    return {std::max(first_column, other.first_column), std::min(end_column, other.end_column),
            std::max(first_row, other.first_row), std::min(end_row, other.end_row)};
}

// A convex body in front of the eye appears between its corners.
PixelBox pixels_of(const IndexBox& box, const Grid& grid, const View& view) {
    constexpr double far = std::numeric_limits<double>::infinity();
    glm::dvec3 ways[8];
    double nearest = far, farthest = -far;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index{(corner & 1) != 0 ? box.max.x : box.min.x,
                               (corner & 2) != 0 ? box.max.y : box.min.y,
                               (corner & 4) != 0 ? box.max.z : box.min.z};
        ways[corner] = grid.to_world(index) - view.eye;
        const double depth = glm::dot(ways[corner], view.forward);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    const bool perspective = view.projection == Projection::perspective;
    if (perspective && !(nearest > nearest_share * farthest))
        return {0, view.width, 0, view.height};
    double left = far, right = -far, top = far, bottom = -far;
    for (const glm::dvec3& way : ways) {
        const double pixel = view.pixel * (perspective ? glm::dot(way, view.forward) : 1);
        const double column = 0.5 * view.width + glm::dot(way, view.right) / pixel;
        const double row = 0.5 * view.height - glm::dot(way, view.up) / pixel;
        left = std::min(left, column);
        right = std::max(right, column);
        top = std::min(top, row);
        bottom = std::max(bottom, row);
    }
    return {clamped(std::floor(left - margin_pixels), view.width),
            clamped(std::ceil(right + margin_pixels), view.width),
            clamped(std::floor(top - margin_pixels), view.height),
            clamped(std::ceil(bottom + margin_pixels), view.height)};
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <span>

#include "mesh/few_points.h"

namespace lamina {

// A convex polygon in window coordinates: pixels to the right and upwards from the picture's lower
// left corner, pixel centres at half integers.
struct ScreenPolygon {
    static constexpr int most_corners = 8;

    int count = 0;
    std::array<glm::vec2, most_corners> corners;
};

// The points whose convex hull is the image of a convex body, in window coordinates.
using ScreenOutline = FewPoints<glm::dvec2, ScreenPolygon::most_corners>;

// A rectangle of pixels, columns from the left and rows from the bottom; empty if last < first.
struct PixelBounds {
    int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
    bool empty() const { return last_column < first_column || last_row < first_row; }
};

// Returns a rectangle with all pixel centres nearer than `margin` pixels to the hull of `points`.
PixelBounds pixel_bounds(std::span<const glm::dvec2> points, double margin, int width, int height);

// Returns a polygon around `points` (at most 8) that covers every pixel centre nearer to their
// convex hull than half of `margin` (2 steps of the rasteriser's grid, in pixels); it has 0 corners
// if it covers no pixel centre of the picture. Corners lie on that grid, because rounding could
// turn very thin polygons over. As a triangle fan around a corner it covers each pixel centre once.
ScreenPolygon surround(std::span<const glm::dvec2> points, double margin, int width, int height);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace lamina {

// A convex polygon in window coordinates: pixels to the right and upwards from the picture's lower
// left corner, pixel centres at half integers.
struct ScreenPolygon {
    static constexpr int most_corners = 8;

    int count = 0;
    std::array<glm::vec2, most_corners> corners;
};

// The points whose convex hull is the image of a convex body, in window coordinates.
struct ScreenOutline {
    std::size_t count = 0;
    std::array<glm::dvec2, ScreenPolygon::most_corners> corners;
    std::span<const glm::dvec2> points() const { return {corners.data(), count}; }
};

// A rectangle of pixels, columns from the left and rows from the bottom; empty if last < first.
struct PixelBounds {
    int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
    bool empty() const { return last_column < first_column || last_row < first_row; }
};

// Returns the pixels of a picture whose centres may lie nearer to the convex hull of `points` than
// `margin`, in pixels.
PixelBounds pixel_bounds(std::span<const glm::dvec2> points, double margin, int width, int height);

// Returns a polygon around `points` (at most 8) that covers every pixel centre nearer to their
// convex hull than half of `margin`. `margin` has to be 2 steps of the rasteriser's grid. The
// polygon's corners lie on that grid, because rounding by the rasteriser could turn very thin
// polygons over. The count is 0 if no pixel centre of a picture of width x height pixels can be
// covered. Drawn as a triangle fan around a corner, it covers each pixel centre once.
ScreenPolygon surround(std::span<const glm::dvec2> points, double margin, int width, int height);

}  // namespace lamina

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

// What is seen of something convex: window coordinates of its corners.
struct ScreenOutline {
    std::size_t count = 0;
    std::array<glm::dvec2, ScreenPolygon::most_corners> corners;
    std::span<const glm::dvec2> points() const { return {corners.data(), count}; }
};

// The pixels of a picture, columns from the left and rows from the bottom, whose centres may lie
// nearer to `points` than `margin`; last < first where there are none.
struct PixelBounds {
    int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
    bool empty() const { return last_column < first_column || last_row < first_row; }
};
PixelBounds pixel_bounds(std::span<const glm::dvec2> points, double margin, int width, int height);

// A polygon around `points` (at most 8) that covers every pixel centre nearer to their convex hull
// than half of `margin`, which is 2 steps of the rasteriser's grid. Its corners lie on that grid:
// rounded by the rasteriser, needles would fold. Of count 0 where no pixel centre of a picture of
// width x height pixels can be covered. Each pixel centre lies in one triangle of a fan around a
// corner.
ScreenPolygon surround(std::span<const glm::dvec2> points, double margin, int width, int height);

}  // namespace lamina

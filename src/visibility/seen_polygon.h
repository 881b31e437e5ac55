// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <span>

#include "mesh/face_tree.h"
#include "scene/window_view.h"

namespace lamina {

// A convex polygon as a picture shows it. Coordinates are in pixels, columns to the right and rows
// downwards; the centre of pixel (i, j) is at (i, j).
struct SeenPolygon {
    // Two triangles, each cut by the near plane, have at most 4 corners each; their overlap has at
    // most the sum.
    static constexpr std::size_t most_corners = 8;

    std::size_t count = 0;
    std::array<glm::dvec2, most_corners> corners;

    void add(const glm::dvec2& corner) {
        if (count < most_corners) corners[count++] = corner;
    }
    double area() const;
};

// Finds which pixels see a triangle or a tet. What lies nearer to the eye's plane than `near` is
// not seen in perspective views; the result never lacks a pixel because of rounding.
class PixelFinder {
  public:
    PixelFinder(const View& view, double near) : window_(view), near_(near) {}

    SeenPolygon polygon(const Triangle& triangle) const;
    // The pixels of the picture whose rays may meet the hull of some points.
    PixelArea pixels_of(std::span<const glm::dvec3> points) const;
    const View& view() const { return window_.view(); }

  private:
    glm::dvec2 place_of(const glm::dvec3& seen) const;

    WindowView window_;
    double near_;
};

// The common part of two convex polygons.
SeenPolygon overlap_of(const SeenPolygon& a, const SeenPolygon& b);

// The smallest rectangle around the pixels of an area whose centres a polygon covers, or nearly
// covers: empty if there are none.
PixelArea covered_pixels(const SeenPolygon& polygon, const PixelArea& area);

// Whether there are any.
bool covers_some(const SeenPolygon& polygon, const PixelArea& area);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "scene/camera.h"

namespace lamina {

// Keeps the part of a convex polygon on which height(corner), a linear function, is >= 0
// (Sutherland and Hodgman, Reentrant polygon clipping, 1974). A Polygon has corners, their count,
// and add().
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

// Finds the pixels that see a triangle or a tet. In perspective views nothing nearer to the eye's
// plane than `near` is seen. The result never lacks a pixel because of rounding.
class PixelFinder {
  public:
    PixelFinder(const View& view, double near) : window_(view), near_(near) {}

    SeenPolygon polygon(const Triangle& triangle) const;
    // Returns the pixels of the picture whose rays may meet the hull of some points.
    PixelArea pixels_of(std::span<const glm::dvec3> points) const;
    const View& view() const { return window_.view(); }

  private:
    glm::dvec2 place_of(const glm::dvec3& seen) const;

    WindowView window_;
    double near_;
};

// Returns the common part of two convex polygons.
SeenPolygon overlap_of(const SeenPolygon& a, const SeenPolygon& b);

// Returns the smallest rectangle around the pixels of an area whose centres a polygon covers, or
// nearly covers; empty if there are none.
PixelArea covered_pixels(const SeenPolygon& polygon, const PixelArea& area);

// Tells whether there are such pixels.
bool covers_some(const SeenPolygon& polygon, const PixelArea& area);

// A triangle as an eye sees it, with the planes through the eye and its edges. The rays through the
// triangle fill a pyramid, or a prism for an eye at infinity.
class SeenTriangle {
  public:
    SeenTriangle() = default;
    SeenTriangle(const Eye& eye, const Triangle& corners);

    // Returns the sign that sign_as_seen() gives for a face of a tet. 1: an exit, through which
    // rays leave the tet. -1: an entry. 0: seen edge-on.
    int sign() const { return sign_; }

    // Tells for an exit whether some of `entry`, of positive seen area, is seen through the exit,
    // on it or behind it. Exact for triangles that do not intersect; for others it is true if some
    // of `entry` lies behind the exit.
    bool shows(const Eye& eye, const SeenTriangle& entry) const;

  private:
    friend class SeenThrough;
    int edge_sign(const Eye& eye, std::size_t corner, const glm::dvec3& point) const;
    int face_sign(const glm::dvec3& point) const;
    int all_on_one_side(const SeenTriangle& other) const;
    bool sees_ahead(const Eye& eye, const SeenTriangle& other) const;
    bool separated_by_edge(const Eye& eye, const SeenTriangle& other) const;
    bool apart(const Eye& eye, const SeenTriangle& entry) const;
    bool behind_where_mixed(const Eye& eye, const SeenTriangle& entry) const;

    Triangle corners_{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
    // Planes of edges 01, 12, 20, through the first corner of each.
    std::array<RoundedPlane, 3> edges_;
    RoundedPlane face_;  // plane of the triangle through corner 0; positive outside the tet
    int sign_ = 0;
};

// The region of space that is seen through an exit, on it or behind it. Boxes are searched for
// faces that it may contain.
class SeenThrough {
  public:
    // `bounds`: a box around all boxes.
    SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds);
    // Tells whether a box or a triangle may contain a point of the region. Rounding never makes
    // this false for one that does.
    template <typename Shape>
    bool reaches(const Shape& box_or_triangle) const {
        return sides_[0].reaches(box_or_triangle) && sides_[1].reaches(box_or_triangle) &&
               sides_[2].reaches(box_or_triangle) && sides_[3].reaches(box_or_triangle);
    }

  private:
    std::array<PlaneSide, 4> sides_;
};

// Returns the seen area of a triangle: its solid angle (steradian), or for an eye at infinity the
// area of its projection (world units squared).
double seen_area(const Eye& eye, const Triangle& triangle);

// Returns the seen area of the region of `entry` that is seen through `exit` (corners clockwise for
// the eye).
double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry);

// Boxes around triangles as an eye sees them. Two coordinates run across the rays and are constant
// along each ray; the third grows along the rays. If two boxes are disjoint, so are the triangles.
// The boxes hold for one side of the eye. A triangle that is not well on that side has a box that
// contains everything.
class SeenBoxes {
  public:
    // Makes boxes for the side of the eye towards `center`.
    SeenBoxes(const Eye& eye, const glm::dvec3& center);

    FaceTree::Box of(const Triangle& triangle) const;

  private:
    bool at_infinity_;
    glm::dvec3 origin_;
    glm::dmat3 axes_;  // columns: two across the rays, one along them
};

// Tells whether some ray may meet a triangle in `exit` and then, or at the same point, one in
// `entry`.
inline bool may_show(const FaceTree::Box& exit, const FaceTree::Box& entry) {
    return entry.max.x >= exit.min.x && entry.min.x <= exit.max.x && entry.max.y >= exit.min.y &&
           entry.min.y <= exit.max.y && entry.max.z >= exit.min.z;
}

}  // namespace lamina

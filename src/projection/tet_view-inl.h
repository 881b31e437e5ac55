// SPDX-License-Identifier: Apache-2.0
// A tet as the eye sees it: one tet (Number: double; TetProjector) or a vector of tets (Double;
// TetSetup). SeenPoints are relative to the eye, along right, up and forward.
//
//   center = the pixel centre in the middle of the corners' bounds, at the mean of their depths
//   for each face A, B, C: n = (B - A) x (C - A), and the depth on the plane n.P = n.A   (6.2)
//   scalar s with gradient g: its value at the center, per z, per column, per row
//   for a level l of the scalar: the depth on the plane g.P = l - s(eye)                (6.2)
//
// Depths and scalars are linear in window coordinates relative to the center (docs/numerics.md,
// section 6; Kraus 2004, section 2.1), which keeps their digits in float32.
#if defined(LAMINA_PROJECTION_TET_VIEW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_VIEW_INL_H_
#undef LAMINA_PROJECTION_TET_VIEW_INL_H_
#else
#define LAMINA_PROJECTION_TET_VIEW_INL_H_
#endif

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <span>

#include "projection/tet_record.h"
#include "scene/camera.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// One point of each tet of a vector.
struct SeenPoints {
    Double x, y, z;
};

LAMINA_INLINE SeenPoints operator-(const SeenPoints& a, const SeenPoints& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LAMINA_INLINE Double dot(const SeenPoints& a, const SeenPoints& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LAMINA_INLINE SeenPoints cross(const SeenPoints& a, const SeenPoints& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

template <typename Number>
struct PointTraits {
    using Point = SeenPoints;
    using Mask = DoubleMask;
};
template <>
struct PointTraits<double> {
    using Point = glm::dvec3;
    using Mask = bool;
};
template <typename Number>
using PointOf = typename PointTraits<Number>::Point;

template <typename Point, typename Number>
LAMINA_INLINE Point scaled(const Point& a, Number factor) {
    return {a.x * factor, a.y * factor, a.z * factor};
}
template <typename Point>
LAMINA_INLINE auto largest_of(const Point& a) {
    return max(abs(a.x), max(abs(a.y), abs(a.z)));
}

// Gradients of linear functions in a tet: numerator() over `determinant`, six times its volume.
template <typename Number>
struct TetSlopes {
    using Point = PointOf<Number>;

    LAMINA_INLINE explicit TetSlopes(const std::array<Point, 4>& corners) {
        const Point e1 = corners[1] - corners[0], e2 = corners[2] - corners[0],
                    e3 = corners[3] - corners[0];
        n1 = cross(e2, e3);
        n2 = cross(e3, e1);
        n3 = cross(e1, e2);
        determinant = dot(e1, n1);
    }
    // `v1` to `v3`: the values at the last three corners minus that at the first.
    LAMINA_INLINE Point numerator(Number v1, Number v2, Number v3) const {
        return {v1 * n1.x + v2 * n2.x + v3 * n3.x, v1 * n1.y + v2 * n2.y + v3 * n3.y,
                v1 * n1.z + v2 * n2.z + v3 * n3.z};
    }

    Point n1, n2, n3;
    Number determinant;
};

// Planes, scalars and bounds of tets relative to a center, in one view.
template <typename Number>
class TetView {
  public:
    using Point = PointOf<Number>;
    using Mask = typename PointTraits<Number>::Mask;

    LAMINA_INLINE explicit TetView(const View& view)
        : view_(view), perspective_(view.projection == Projection::perspective) {}

    LAMINA_INLINE bool perspective() const { return perspective_; }
    // Returns the depth (tet_record.h) of a z; or the z of a depth, by the same formula.
    LAMINA_INLINE Number inverted(Number value) const { return perspective_ ? -1 / value : value; }

    // Returns window coordinates.
    LAMINA_INLINE std::array<Number, 2> in_window(const Point& p) const {
        const Number scale = perspective_ ? view_.pixel * p.z : Number(view_.pixel);
        return {0.5 * view_.width + p.x / scale, 0.5 * view_.height + p.y / scale};
    }

    // The corners' bounds in window coordinates and along z.
    struct Bounds {
        Number lo_x, hi_x, lo_y, hi_y, nearest, farthest;
    };
    // Sets the center, which is equal for all fragments of a tet, so that they find their common
    // cuts at the same depth. `corners`: of the tet, or of its region beyond the near plane.
    LAMINA_INLINE Bounds place_center(std::span<const Point> corners) {
        const double width = view_.width, height = view_.height,
                     count = static_cast<double>(corners.size());
        Bounds bounds{INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, 0};
        Number mean = 0;
        for (const Point& p : corners) {
            const auto [x, y] = in_window(p);
            bounds.lo_x = min(bounds.lo_x, x);
            bounds.hi_x = max(bounds.hi_x, x);
            bounds.lo_y = min(bounds.lo_y, y);
            bounds.hi_y = max(bounds.hi_y, y);
            mean += p.z / count;
            bounds.nearest = min(bounds.nearest, p.z);
            bounds.farthest = max(bounds.farthest, p.z);
        }
        const Number lo_x = clamp(bounds.lo_x, 0, width), hi_x = clamp(bounds.hi_x, 0, width),
                     lo_y = clamp(bounds.lo_y, 0, height), hi_y = clamp(bounds.hi_y, 0, height);
        columns_ = hi_x - lo_x;
        rows_ = hi_y - lo_y;
        center_x = rounded_to_float(floor(0.5 * (lo_x + hi_x)) + 0.5);
        center_y = rounded_to_float(floor(0.5 * (lo_y + hi_y)) + 0.5);
        column_ = center_x - 0.5 * width;
        row_ = center_y - 0.5 * height;
        center_depth = rounded_to_float(inverted(mean));
        center_z = inverted(center_depth);
        const Number thickness = bounds.farthest - bounds.nearest;
        // A change of 1 / z changes z most at the far end.
        depth_range = perspective_ ? thickness / (bounds.farthest * bounds.farthest) : thickness;
        return bounds;
    }

    // A depth, minus the center's, on a plane: at the center, and its change per column and row.
    struct DepthPlane {
        Number depth, per_column, per_row;
    };
    // Returns the divisor of plane() for this normal and offset. It is 0 if the eye is in the plane
    // (perspective) or the plane is seen edge-on (orthographic).
    LAMINA_INLINE Number divisor(const Point& normal, Number offset) const {
        return perspective_ ? offset : Number(normal.z);
    }
    // Returns the plane normal.P = offset. `divisor`: divisor(), or a replacement for one near 0.
    LAMINA_INLINE DepthPlane plane(const Point& normal, Number offset, Number divisor) const {
        const Number per_pixel = -view_.pixel / divisor;
        const Number per_column = normal.x * per_pixel, per_row = normal.y * per_pixel;
        const Number at_middle = (perspective_ ? -normal.z : offset) / divisor;
        return {at_middle + column_ * per_column + row_ * per_row - center_depth, per_column,
                per_row};
    }
    // Returns a bound on the sizes of the terms whose rounding affects a depth on the plane, for
    // pixels within the corners' bounds.
    LAMINA_INLINE Number size_of(const DepthPlane& plane) const {
        return abs(plane.depth) + columns_ * abs(plane.per_column) + rows_ * abs(plane.per_row);
    }

    // The plane on which the scalar has a given level: gradient.P = above_eye, the level minus the
    // scalar at the eye. If this is above 0, the plane is the front of the region of larger
    // scalars. If the plane passes through the eye it is seen edge-on: all three numbers are huge,
    // and only their signs count, that is, on which side of the edge a pixel lies.
    struct Level {
        DepthPlane plane;
        Mask front;
    };
    LAMINA_INLINE Level level(const Point& gradient, Number above_eye) const {
        const Number exact = divisor(gradient, above_eye);
        const Mask positive = exact >= 0;
        const Number kept = select(positive, max(exact, 1e-200), min(exact, -1e-200));
        const DepthPlane found = plane(gradient, above_eye, kept);
        const Number size =
            max(max(abs(found.depth), max(abs(found.per_column), abs(found.per_row))), 1);
        const Number factor = min(1, beyond_all / size);
        return {{found.depth * factor, found.per_column * factor, found.per_row * factor},
                positive};
    }

    // Returns the point from which fragments measure depths, whose z belongs to center_depth
    // exactly. center_z is rounded, by much compared with a small tet far away.
    LAMINA_INLINE Point center() const {
        const Number x = column_ * view_.pixel, y = row_ * view_.pixel;
        if (!perspective_) return {x, y, center_z};
        return {x * center_z, y * center_z, center_z};
    }
    // A linear function: at the center, along the ray per unit of z, per column and per row.
    using Linear = std::array<Number, 4>;
    LAMINA_INLINE Linear linear(Number at_center, const Point& gradient) const {
        const Number x = column_ * view_.pixel, y = row_ * view_.pixel;
        const Point direction = perspective_ ? Point{x, y, 1} : Point{0, 0, 1};
        return {at_center, dot(gradient, direction), gradient.x * view_.pixel,
                gradient.y * view_.pixel};
    }

    // Window coordinates, depth and z of the center.
    Number center_x, center_y, center_depth, center_z;
    Number depth_range;  // the tet's thickness in depth at its far end

  private:
    const View& view_;
    bool perspective_;
    Number columns_, rows_;  // size of the corners' bounds in the picture, in pixels
    Number column_, row_;    // the center relative to the picture's middle, in pixels
};

template <typename Number>
LAMINA_INLINE Number finite(Number value) {
    return clamp(value, -beyond_all, beyond_all);
}

// Returns the length of the longest edge.
template <typename Number>
LAMINA_INLINE Number longest_edge(const std::array<PointOf<Number>, 4>& corners) {
    Number longest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
            const auto edge = corners[j] - corners[i];
            longest = max(longest, dot(edge, edge));
        }
    }
    return sqrt(longest);
}

LAMINA_SIMD_END

#endif

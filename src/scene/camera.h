// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "lamina/camera.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "mesh/predicates.h"

namespace lamina {

// The viewing rays of an image. Pixel (i, j), row 0 at the top, has its centre at the image-plane
// coordinates x(i), y(j). A point of a ray is origin + z * direction; z >= 0 is eye-space depth,
// the distance from the eye's plane, so the forward component of the direction is 1.
struct View {
    // Throws Error if the camera is singular.
    View(const Camera& camera, int width_pixels, int height_pixels);

    struct Ray {
        glm::dvec3 origin, direction;  // |direction| >= 1: world length per unit of z
    };
    Ray ray(double column, double row) const;  // pixel (i, j): ray(i, j); fractions are allowed

    double x(double column) const { return (column + 0.5 - 0.5 * width) * pixel; }
    double y(double row) const { return (0.5 * height - (row + 0.5)) * pixel; }

    Projection projection;
    int width, height;
    double pixel;  // edge of a pixel: at z = 1 (perspective) or in world units (orthographic)
    glm::dvec3 eye, right, up, forward;  // orthonormal
};

// Least cosine between a camera's `up` and what is up in its picture. Below it the view is along
// `up`, about which it cannot turn.
inline constexpr double least_across = 0.02;

inline Eye eye_of(const View& view) {
    if (view.projection == Projection::orthographic) return {view.forward, true};
    return {view.eye, false};
}

// Degrees by which the camera turns between timed frames (--frames; studies: docs/study.md).
inline constexpr double degrees_per_frame = 0.1;

// Returns the view with axes of length `unit`, so that products of world points with them are
// eye-space coordinates in that unit (world_unit()).
inline View seeing_in_units(View view, double unit) {
    for (glm::dvec3* const axis : {&view.right, &view.up, &view.forward}) *axis *= unit;
    if (view.projection == Projection::orthographic) view.pixel *= unit;
    return view;
}

// Converts points to eye space and to pixels, right and up from the picture's lower left corner.
class WindowView {
  public:
    explicit WindowView(const View& view)
        : view_(view),
          middle_(0.5 * view.width, 0.5 * view.height),
          perspective_(view.projection == Projection::perspective) {}

    const View& view() const { return view_; }
    const glm::dvec2& middle() const { return middle_; }
    bool perspective() const { return perspective_; }

    // Returns a point's eye-space coordinates: along right, up and forward from the eye.
    glm::dvec3 see(const glm::dvec3& point) const {
        const glm::dvec3 p = point - view_.eye;
        return {glm::dot(p, view_.right), glm::dot(p, view_.up), glm::dot(p, view_.forward)};
    }
    glm::dvec2 to_window(const glm::dvec3& seen) const {
        const double scale = perspective_ ? view_.pixel * seen.z : view_.pixel;
        return middle_ + glm::dvec2(seen.x / scale, seen.y / scale);
    }

  private:
    View view_;
    glm::dvec2 middle_;
    bool perspective_;
};

inline double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

// Pixels by which ray_perturbation() moves rays off faces. More would change pictures of thin
// opaque tets (this changes a needle of optical depth 1e4 by .03 / 255). Less is lost in rounding:
// along the world's z it is 3e-12 pixels, and two floats resolve 3.5e-15 of a pixel's number.
inline constexpr double tie_pixels = 3e-8;

// Returns the perturbation of rays along right, up, forward, directed as in the reference tracer
// (mesh/ray_walk.cpp): along the world's x, far less along y, far less again along z.
inline glm::dvec3 ray_perturbation(const View& view) {
    const glm::dvec3 direction(1, 1e-2, 1e-4);
    const bool perspective = view.projection == Projection::perspective;
    return tie_pixels * glm::dvec3(glm::dot(view.right, direction), glm::dot(view.up, direction),
                                   perspective ? glm::dot(view.forward, direction) : 0);
}

// A rectangle of pixels, rows from the top, first to last (included). Empty if last < first.
struct PixelArea {
    std::int32_t first_column, last_column, first_row, last_row;

    bool empty() const { return last_column < first_column || last_row < first_row; }
    std::int64_t count() const {
        if (empty()) return 0;
        return std::int64_t{last_column - first_column + 1} * (last_row - first_row + 1);
    }
    // Grows to the smallest rectangle that holds both; empty ones do not count.
    void add(const PixelArea& other) {
        if (other.empty()) return;
        if (empty()) *this = other;
        first_column = std::min(first_column, other.first_column);
        last_column = std::max(last_column, other.last_column);
        first_row = std::min(first_row, other.first_row);
        last_row = std::max(last_row, other.last_row);
    }
};

inline PixelArea common_pixels(const PixelArea& a, const PixelArea& b) {
    return {std::max(a.first_column, b.first_column), std::min(a.last_column, b.last_column),
            std::max(a.first_row, b.first_row), std::min(a.last_row, b.last_row)};
}

// Renderers measure lengths in a unit in which the scene has about size 1, because worlds may be
// atoms or galaxies, and float32 overflows at the square of 1e20. The unit is a power of two: a
// world twice as large, with half the extinction, gives the same picture bit for bit.

// Returns the factor from world units that makes `diagonal` 1 to 2; 1 if `diagonal` is 0.
double world_unit(double diagonal);
double box_diagonal(const Grid& grid);

Grid in_units(Grid grid, double unit);
View in_units(View view, double unit);
// Converts the extinctions, which are per unit of length.
TransferFunction in_units(const TransferFunction& transfer_function, double unit);

}  // namespace lamina

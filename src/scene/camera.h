// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "lamina/camera.h"
#include "mesh/predicates.h"

namespace lamina {

// The viewing rays of an image. The centre of pixel (i, j), row 0 at the top, has the image-plane
// coordinates x(i), y(j). The parameter along a ray is eye-space depth z, the distance from the
// eye's plane. So the forward component of the direction is 1, and a point of the ray is origin + z
// * direction. There is no near plane: z starts at 0.
struct View {
    View(const Camera& camera, int width_pixels,
         int height_pixels);  // throws Error when the camera is singular

    struct Ray {
        glm::dvec3 origin, direction;  // |direction| >= 1: world length per unit of z
    };
    Ray ray(double column, double row) const;  // pixel (i, j): ray(i, j); fractions allowed

    double x(double column) const { return (column + 0.5 - 0.5 * width) * pixel; }
    double y(double row) const { return (0.5 * height - (row + 0.5)) * pixel; }

    Projection projection;
    int width, height;
    double pixel;  // edge of a pixel: at z = 1 (perspective), in world units (orthographic)
    glm::dvec3 eye, right, up, forward;  // orthonormal
};

// The eye of a view, for visibility orders.
inline Eye eye_of(const View& view) {
    if (view.projection == Projection::orthographic) return {view.forward, true};
    return {view.eye, false};
}

// The turn of the camera between timed frames (--frames; studies: docs/study.md).
inline constexpr double degrees_per_frame = 0.1;

}  // namespace lamina

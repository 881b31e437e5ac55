// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "lamina/camera.h"
#include "mesh/eye.h"

namespace lamina {

// The viewing rays of an image: pixel (i, j), row 0 at the top, has its centre at image-plane
// coordinates x(i), y(j). Along a ray the parameter is eye-space depth z (distance from the eye's
// plane), so the direction's forward component is 1 and a ray's point is origin + z * direction. No
// near plane: z starts at 0.
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

// For visibility orders.
inline Eye eye_of(const View& view) {
    if (view.projection == Projection::orthographic) return {view.forward, true};
    return {view.eye, false};
}

// Timed frames of a moving camera (--frames, studies: docs/study.md) are this far apart.
inline constexpr double degrees_per_frame = 0.1;

}  // namespace lamina

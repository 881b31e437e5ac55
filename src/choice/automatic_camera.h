// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "lamina/camera.h"
#include "lamina/grid.h"

namespace lamina {

// Degrees by which a camera goes around its centre: to the right, and up.
struct ViewTurn {
    double azimuth = 0, elevation = 0;
};

// Returns a perspective camera in three-quarter view that fits one or more points: all are in the
// picture of width x height pixels, and two opposite edges of a margin of 1/25 are touched. If the
// axes of the world are a patient's, the camera looks from in front and a little from the left and
// above, the head up; otherwise from +z, a little from +x and +y, with +y up. `turn` is added to
// that. `all_around`: all points stay in the picture however far the camera turns about its `up`
// (scene/camera.h).
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height, bool all_around = false);

// Returns the camera moved around its centre, to its right and up. Its up vector turns with it, so
// that it can cross the poles.
Camera turned(const Camera& camera, const ViewTurn& turn);

// Returns the camera with objects `factor` times as large in the picture.
Camera zoomed(Camera camera, double factor);

}  // namespace lamina

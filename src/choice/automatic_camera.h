// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "lamina/camera.h"
#include "lamina/grid.h"

namespace lamina {

// From where a camera looks, in degrees: how far it went around what shows, to the right and up.
struct ViewTurn {
    double azimuth = 0, elevation = 0;
};

// A perspective camera in three-quarter view that fits the points: all are in the picture, and two
// opposite edges of a margin of 1/25 are touched. Where the axes of the world are a patient's it
// looks from in front and a little from the left and above, the head up. Else it looks from +z, a
// little from +x and +y, with +y up. `turn` comes on top. One or more points; a picture of
// width x height pixels. `all_around`: however far the camera is turned about its `up`
// (scene/camera.h), all points are in the picture.
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height, bool all_around = false);

// The camera gone around its centre, to its right and up. It turns with its up, so that it may go
// over the poles.
Camera turned(const Camera& camera, const ViewTurn& turn);

// The camera with a picture that shows things `factor` times as large.
Camera zoomed(Camera camera, double factor);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "lamina/volume.h"

namespace lamina {

enum class Projection { perspective, orthographic };

// A camera at `eye` that looks at `center`, in world coordinates. `up` need not be at a right angle
// to the view, but must not be parallel to it.
struct Camera {
    Projection projection = Projection::perspective;
    glm::dvec3 eye{0, 0, 1};
    glm::dvec3 center{0};
    glm::dvec3 up{0, 1, 0};
    double fov_y = 40;  // vertical field of view in degrees, for perspective views
    double height = 1;  // height of the picture in world units, for orthographic views
};

LAMINA_API const char* name_of(Projection projection);

// Returns the camera with its eye turned by `degrees` about the axis `up` through `center`.
LAMINA_API Camera turned(const Camera& camera, double degrees);

// Returns a perspective camera that sees all of a box from outside. It looks from the box's +z side
// at azimuth and elevation 0; a larger azimuth moves it to the right (+x), a larger elevation up
// (+y). All angles are in degrees.
LAMINA_API Camera orbit(const Grid::Bounds& box, double azimuth, double elevation,
                        double fov_y = 40);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Motions of the camera: each function takes a camera and returns the next one. Places in the
// picture are in shares of its height from its middle, to the right and up, so that nothing depends
// on pixels.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "lamina/camera.h"
#include "lamina/grid.h"

namespace lamina::view {

// Axes of the picture in the world: right, up, and away from the eye. Orthonormal.
struct ViewAxes {
    glm::dvec3 right, up, forward;
};
ViewAxes axes_of(const Camera& camera);

// World units for one height of the picture, at the distance of the camera's centre.
double height_at_center(const Camera& camera);

// Turns the camera around the centre, whose distance stays: half a turn for one height of the
// picture. The scene follows the drag. The view never comes closer than a degree to `up`.
Camera orbited(const Camera& camera, const glm::dvec2& drag);
// Moves eye and centre so that objects at the centre's distance follow the drag.
Camera panned(const Camera& camera, const glm::dvec2& drag);
// Zooms: objects at the centre's distance become 1 / `factor` times as large. The one at `place`
// keeps its position in the picture.
Camera zoomed(const Camera& camera, double factor, const glm::dvec2& place = glm::dvec2(0));
// Moves eye and centre by `step` world units to the right, up and forward. Orthographic views are
// enlarged instead of moved forward, which would change nothing.
Camera flown(const Camera& camera, const glm::dvec3& step);
// Brings the point to the middle of the picture and makes it the centre of turns. A perspective
// view turns, an orthographic one is shifted.
Camera looking_at(const Camera& camera, const glm::dvec3& point);
// Shows all of the box, from the same direction and as large as that allows. `aspect`: width of the
// picture by its height.
Camera fitted(const Camera& camera, const Grid::Bounds& box, double aspect);
// Looks from the direction `from` at the middle of the box, fitted. z is up, or y if the view is
// along z.
Camera seen_from(const Camera& camera, const glm::dvec3& from, const Grid::Bounds& box,
                 double aspect);
// Returns the other projection; objects at the centre's distance keep their size.
Camera with_projection(const Camera& camera, Projection projection);

}  // namespace lamina::view

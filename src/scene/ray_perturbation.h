// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scene/camera.h"

namespace lamina {

// The ray perturbation: rays that run along faces are moved by so many pixels. More changes
// pictures of thin opaque tets: the optical depth 1e4 of a needle by .03 / 255. Less is lost along
// z: there it is 3e-12 pixels, and two floats side by side hold 3.5e-15 of a pixel's number.
inline constexpr double tie_pixels = 3e-8;

// The perturbation along right, up and forward. Its direction is the one in which the tracer moves
// rays that meet edges and corners (mesh/ray_walk.cpp): along the world's x, y and z, each far less
// than the one before.
inline glm::dvec3 ray_perturbation(const View& view) {
    const glm::dvec3 direction(1, 1e-2, 1e-4);
    const bool perspective = view.projection == Projection::perspective;
    return tie_pixels * glm::dvec3(glm::dot(view.right, direction), glm::dot(view.up, direction),
                                   perspective ? glm::dot(view.forward, direction) : 0);
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scene/camera.h"

namespace lamina {

// The ray perturbation: rays that run along faces are moved by so many pixels. This is far below
// what pictures resolve and far above the rounding of doubles.
inline constexpr double tie_pixels = 1e-7;

// The perturbation along right, up and forward. Its direction is the one in which the tracer moves
// rays that meet edges and corners (mesh/ray_walk.cpp): along the world's x, y and z, each far less
// than the one before.
inline glm::dvec3 ray_perturbation(const View& view) {
    const glm::dvec3 direction(1, 3e-3, 1e-5);
    const bool perspective = view.projection == Projection::perspective;
    return tie_pixels * glm::dvec3(glm::dot(view.right, direction), glm::dot(view.up, direction),
                                   perspective ? glm::dot(view.forward, direction) : 0);
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace lamina {

// Where a mesh is looked at from, all that a visibility order depends on.
struct Eye {
    // World; at infinity (orthographic views): the viewing direction, away from the eye, of any
    // length but 0.
    glm::dvec3 position{0};
    bool at_infinity = false;
};

}  // namespace lamina

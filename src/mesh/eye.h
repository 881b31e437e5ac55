// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace lamina {

// The eye that looks at a mesh. A visibility order depends on nothing else of the view.
struct Eye {
    // World coordinates. For an eye at infinity (orthographic views) it is the viewing direction
    // away from the eye, of any length but 0.
    glm::dvec3 position{0};
    bool at_infinity = false;
};

}  // namespace lamina

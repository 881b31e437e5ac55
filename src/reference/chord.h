// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "lamina/grid.h"
#include "scene/camera.h"

namespace lamina {

// The part of a viewing ray (z >= 0) that is inside a grid's box: entry + s * direction, 0 <= s <=
// length_z, in index space. Starting at the entry, however far away the eye is, keeps its distance
// out of all later rounding.
struct Chord {
    glm::dvec3 entry{0};  // index space, inside the closed box
    // Index space, per unit of z; exactly 0 along axes that the ray is perpendicular to.
    glm::dvec3 direction{0};
    double length_z = 0;     // 0: the ray misses the box, or only touches it in a point
    double world_per_z = 0;  // world length per unit of z

    double world_length() const { return length_z * world_per_z; }
};

// The ray's own numbers and the grid's are taken as exact; from them, length_z is good to 1e-15
// relative, also for chords that are slivers at an edge of the box, seen from far away. The box is
// closed: a ray in a face is inside.
Chord clip_to_box(const Grid& grid, const View::Ray& ray);

// World length of the ray of pixel (column, row) (fractions allowed) inside the box.
double chord_length(const Grid& grid, const View& view, double column, double row);

}  // namespace lamina

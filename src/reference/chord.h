// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <span>

#include "lamina/grid.h"
#include "reference/grid_axes.h"
#include "scene/camera.h"
#include "scene/half_space.h"

namespace lamina {

// The segment of a viewing ray (z >= 0) inside a grid's box: entry + s * direction, 0 <= s <=
// length_z, in index space. Because it starts at the entry, the distance of a far eye does not
// enter later rounding.
struct Chord {
    glm::dvec3 entry{0};  // index space, inside the closed box
    // In index space, per unit of z. It is exactly 0 along axes to which the ray is perpendicular.
    glm::dvec3 direction{0};
    double length_z = 0;     // 0 where the ray misses the box or only touches it in a point
    double world_per_z = 0;  // world length per unit of z

    double world_length() const { return length_z * world_per_z; }
    // A place in a cell, in coordinates of the cell (0..1).
    glm::dvec3 place_in_cell(const glm::dvec3& corner, double at) const {
        return glm::clamp(entry + at * direction - corner, glm::dvec3(0), glm::dvec3(1));
    }
};

// Clips a ray to the box, and to the half-spaces of a clip. The numbers of ray and grid are taken
// as exact. length_z has a relative error of 1e-15, also for very short chords at an edge of the
// box that is seen from far away. The box is closed: a ray in a face is inside.
// Clips some rays together, in vectors. There must be as many chords as rays.
void clip_to_box(const GridAxes& grid, std::span<const View::Ray> rays,
                 std::span<const HalfSpace> clip, std::span<Chord> chords);
Chord clip_to_box(const GridAxes& grid, const View::Ray& ray, std::span<const HalfSpace> clip = {});
Chord clip_to_box(const Grid& grid, const View::Ray& ray, std::span<const HalfSpace> clip = {});

// World length of the ray of pixel (column, row) (fractions allowed) inside the box.
double chord_length(const Grid& grid, const View& view, double column, double row);

}  // namespace lamina

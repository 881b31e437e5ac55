// SPDX-License-Identifier: Apache-2.0
// Chords: the parts of viewing rays in a grid's box, and in the half-spaces of a clip. Places in
// the box are computed in twice the precision of double, because eyes may be far away.
//
//   for each axis of the grid, with position p and slope q of the ray along it, in index space:
//       the ray is inside between the z at which p + q z meets the box's two faces      (9.7)
//   cut the range of z that is left by the clip (clip.h)
//   entry = the place of its front end, exactly on the face by which the ray enters
#pragma once

#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "base/arithmetic.h"
#include "lamina/grid.h"
#include "scene/camera.h"
#include "scene/half_space.h"

namespace lamina {

// Values of a grid that clip_to_box() needs, computed once for all rays.
struct GridAxes {
    // A step of the grid, scaled by a power of two so that its square does not underflow.
    struct Axis {
        glm::dvec3 scaled;
        DoubleDouble inverse_square;  // of the scaled one
        double unscale;               // the power of two
    };

    explicit GridAxes(const Grid& grid);

    glm::dvec3 origin;
    glm::dvec3 lowest, highest;  // corners of the box, in index space
    std::array<Axis, 3> axes;
};

// The range of a viewing ray (z >= 0) inside a grid's box: entry + s * direction, 0 <= s <=
// length_z, in index space. Because it starts at the entry, the distance of a far eye does not
// enter later rounding.
struct Chord {
    glm::dvec3 entry{0};  // index space, inside the closed box
    // Change in index space per unit of z. It is exactly 0 along axes to which the ray is
    // perpendicular.
    glm::dvec3 direction{0};
    double length_z = 0;     // 0 if the ray misses the box or only touches it in a point
    double world_per_z = 0;  // world length per unit of z

    double world_length() const { return length_z * world_per_z; }
    // Returns a place in a cell, in coordinates of the cell (0..1).
    glm::dvec3 place_in_cell(const glm::dvec3& corner, double at) const {
        return glm::clamp(entry + at * direction - corner, glm::dvec3(0), glm::dvec3(1));
    }
};

// Clips a ray to the box, and to the half-spaces of a clip. The numbers of ray and grid are taken
// as exact. length_z has a relative error of 1e-15, also for very short chords at an edge of the
// box that is seen from far away. The box is closed: a ray in a face is inside.
// Rays are clipped together, in vectors. There must be as many chords as rays.
void clip_to_box(const GridAxes& grid, std::span<const View::Ray> rays,
                 std::span<const HalfSpace> clip, std::span<Chord> chords);
Chord clip_to_box(const GridAxes& grid, const View::Ray& ray, std::span<const HalfSpace> clip = {});
Chord clip_to_box(const Grid& grid, const View::Ray& ray, std::span<const HalfSpace> clip = {});

// Returns the world length of the ray of pixel (column, row) (fractions allowed) inside the box.
double chord_length(const Grid& grid, const View& view, double column, double row);

}  // namespace lamina

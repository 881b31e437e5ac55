// SPDX-License-Identifier: Apache-2.0
// Chords: the parts of viewing rays in a grid's box and in a clip, computed in twice the precision
// of double, because eyes may be far away.
//   for each axis of the grid, with position p and slope q of the ray along it, in index space:
//       the ray is inside between the z at which p + q z meets the box's two faces      (9.7)
//   for each half-space of the clip, with place and direction relative to its plane:
//       cut the range of z at -place / direction; nothing is left if it is parallel and outside
//   entry = the place of its front end, exactly on the face by which the ray enters
#pragma once

#include <glm/common.hpp>
#include <span>

#include "base/arithmetic.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "scene/clip.h"

namespace lamina {

// The range from <= z <= to of a viewing ray's parameter z. It is empty if !(from < to).
struct RaySpan {
    DoubleDouble from, to;
};

// Cuts away all outside of the half-spaces, taken as exact. Keeps a ray that lies in a plane.
void clip_span(std::span<const HalfSpace> clip, const View::Ray& ray, RaySpan& span);

// The range of a ray's z that is in front of the eye (or of the eye's plane) and that a clip keeps.
struct SeenRange {
    double from, to;
};
SeenRange seen_range(std::span<const HalfSpace> clip, const View::Ray& ray);

// The axes of a grid, prepared for the conversion of rays to index space.
struct GridAxes {
    // A grid step, scaled by a power of two so that its square does not underflow.
    struct Axis {
        glm::dvec3 scaled;
        DoubleDouble inverse_square;  // 1 / |scaled|^2
        double unscale;               // the power of two with scaled = unscale * step
    };

    explicit GridAxes(const Grid& grid);

    glm::dvec3 origin;
    glm::dvec3 lowest, highest;  // corners of the box, in index space
    std::array<Axis, 3> axes;
};

// The part of a viewing ray inside a grid's box: entry + s * direction, 0 <= s <= length_z. It
// begins at the box, so the distance of a far eye does not increase later rounding errors.
struct Chord {
    glm::dvec3 entry{0};      // in index space, inside the closed box
    glm::dvec3 direction{0};  // per unit of z; exactly 0 along axes perpendicular to the ray
    double length_z = 0;      // 0 if the ray misses the box or only touches it in a point
    double world_per_z = 0;   // world length per unit of z

    double world_length() const { return length_z * world_per_z; }
    // Returns the place at `at` in coordinates (0..1) of the cell with lowest corner `corner`.
    glm::dvec3 place_in_cell(const glm::dvec3& corner, double at) const {
        return glm::clamp(entry + at * direction - corner, glm::dvec3(0), glm::dvec3(1));
    }
};

// Clips rays to the closed box and the half-spaces, in vectors. Their numbers are taken as exact.
// length_z has a relative error of 1e-15, even at an edge of a box that is far away.
void clip_to_box(const GridAxes& grid, std::span<const View::Ray> rays,
                 std::span<const HalfSpace> clip, std::span<Chord> chords);
Chord clip_to_box(const GridAxes& grid, const View::Ray& ray, std::span<const HalfSpace> clip = {});
Chord clip_to_box(const Grid& grid, const View::Ray& ray, std::span<const HalfSpace> clip = {});

// Returns the world length, inside the box, of the ray of a pixel (fractions allowed).
double chord_length(const Grid& grid, const View& view, double column, double row);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Decides which axis of the data is up in the picture of an automatic camera, and which side is
// the front (docs/first-picture.md, "How the camera is chosen").
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "lamina/volume.h"

namespace lamina {

// Degrees by which a camera moves around its centre: to the right (azimuth) and up (elevation).
struct ViewTurn {
    double azimuth = 0, elevation = 0;
};

// A camera's own axes: right-handed and orthonormal, unless the world is left-handed.
struct Axes {
    glm::dvec3 right, up, toward;  // from the scene to the eye
};

// Returns the axes of a camera moved right by the azimuth, then up by the elevation.
Axes turned(const Axes& axes, const ViewTurn& turn);

// The axis of the world that is up in the picture: "+x", "-x", ...
enum class UpAxis { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
const char* name_of(UpAxis axis);

// The side from which the data are seen. iso: a three-quarter view, from in front.
enum class ViewSide { iso, front, back, left, right, top, bottom };
const char* name_of(ViewSide side);

// The front of the data: the axes of a camera there, and why these.
struct Orientation {
    Axes front;
    bool patient = false;     // left and right are those of a patient who is seen from in front
    std::string reason = {};  // for people: "+z is up, as asked"
    bool flat = false;        // the three-quarter view would see the edge, so it looks from above
    bool straight = false;    // the front is the view: nothing is behind it
};

// A volume of one sample along one axis: the steps of its other two axes in the world, the faster
// one first, and how thick it is.
struct SliceAxes {
    glm::dvec3 right, down;
    double thickness = 0;
};

// Returns the orientation of data in a box of the world with these corners. `up`: as asked.
// `axial_slices`: axes without names seem to be those of slices of a body (Field::axial_slices()).
Orientation orientation_of(WorldAxes axes, const std::array<glm::dvec3, 8>& corners,
                           std::optional<UpAxis> up = {}, bool axial_slices = false);

// Returns the orientation in which one slice is seen as a picture: its first axis to the right, the
// second down; a patient's as radiologists look at it, from the feet, from in front or from the
// left. `up`: as asked; then the other axis grows to the right as before, or as it grew downwards.
// Returns nothing if `up` is across the slice.
std::optional<Orientation> orientation_of_slice(const SliceAxes& slice, WorldAxes axes,
                                                std::optional<UpAxis> up = {});

// Returns the turn from the front to the camera that sees this side.
ViewTurn turn_to(ViewSide side, const Orientation& orientation);

}  // namespace lamina

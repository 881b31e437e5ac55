// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/eye.h"
#include "visibility/seen_triangle.h"

namespace lamina {

// How large a triangle looks: its solid angle (steradian), or for an eye at infinity the area of
// its projection (world units squared).
double seen_area(const Eye& eye, const Triangle& triangle);

// The part of `entry` that is seen through `exit` (corners clockwise for the eye), in the same
// unit.
double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry);

}  // namespace lamina

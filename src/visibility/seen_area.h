// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/predicates.h"
#include "visibility/seen_triangle.h"

namespace lamina {

// The seen area of a triangle: its solid angle (steradian), or for an eye at infinity the area of
// its projection (world units squared).
double seen_area(const Eye& eye, const Triangle& triangle);

// The seen area of the region of `entry` that is seen through `exit` (corners clockwise for the
// eye).
double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/grid.h"

namespace lamina {

// What a format calls its steps between samples, and the place of the first.
struct GridWords {
    const char* directions;  // "space directions"
    const char* origin;      // "space origin"
};

// Throws Error unless all steps are finite, neither vanish nor overflow when squared, and are
// orthogonal, up to the digits that headers have. They may be oblique in the world, and mirrored.
void check_grid(const std::string& file, const Grid& grid, const GridWords& words);

// Turns a grid in these axes to those of DICOM (LPS), which are the world's. Samples stay where
// they are in the body. Axes without a name stay as they are.
void turn_to_lps(Grid& grid, WorldAxes axes);

}  // namespace lamina

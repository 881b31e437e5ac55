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

// Turns the axes of a grid in the axes of NIfTI, where x grows to the patient's right and y to the
// front (RAS), to those of DICOM and NRRD (LPS). Samples stay where they are in the body.
void turn_to_lps(Grid& grid);

}  // namespace lamina

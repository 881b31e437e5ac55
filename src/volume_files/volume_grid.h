// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "lamina/grid.h"

namespace lamina {

// Makes a grid of which only the size is known: samples 1 apart from 0 on, each a node; the sample
// of an axis with one is a cell.
inline Grid plain_grid(const std::array<std::int64_t, 3>& size) {
    Grid grid;
    grid.size = size;
    for (std::size_t axis = 0; axis < 3; ++axis)
        grid.centering[axis] = size[axis] == 1 ? Centering::cell : Centering::node;
    return grid;
}

// The words of a format for the steps between samples and the place of the first.
struct GridWords {
    const char* directions;  // "space directions"
    const char* origin;      // "space origin"
};

// Throws Error unless all steps are finite, neither vanish nor overflow when squared, and are
// orthogonal, up to the digits that headers have. They may be oblique in the world, and mirrored.
void check_grid(const std::string& file, const Grid& grid, const GridWords& words);

// Turns a grid from these axes to those of DICOM (LPS), which are the world's. Samples stay at
// their places in the body. A grid in unnamed axes stays as it is.
void turn_to_lps(Grid& grid, WorldAxes axes);

}  // namespace lamina

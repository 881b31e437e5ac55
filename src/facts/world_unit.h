// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/grid.h"
#include "lamina/transfer_function.h"
#include "scene/camera.h"

namespace lamina {

// Lengths are measured in a unit in which the scene has about size 1, because worlds may be as
// small as atoms or as large as galaxies, and float32 overflows at the square of 1e20. The unit is
// a power of two, so that no digit changes: a world twice as large, with half the extinction, gives
// the same picture bit for bit.

// Returns the factor from world lengths to these units: `diagonal` becomes 1 to 2. It is 1 if the
// diagonal is 0.
double world_unit(double diagonal);
double box_diagonal(const Grid& grid);

Grid in_units(Grid grid, double unit);
View in_units(View view, double unit);
// Converts extinctions, which are per length.
TransferFunction in_units(const TransferFunction& transfer_function, double unit);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/transfer_function.h"
#include "optics/colormap.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Returns the function with its first and last point moved to the ends of the range, lo < hi, and
// all others in proportion. Throws Error if it has a single point, or if the range is so narrow
// that three points would get one value.
TransferFunction stretched(const TransferFunction& transfer_function, const ValueRange& range);

// Returns the function with the colours of a map, spread from its first to its last point unless
// the map has a range of its own (Colormap::own_range). A function of one point gets the middle
// colour.
TransferFunction recolored(const TransferFunction& transfer_function, Colormap colormap);

}  // namespace lamina

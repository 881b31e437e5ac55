// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/transfer_function.h"
#include "optics/colormap.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The function with its first and its last point moved to the ends of the range, lo < hi, and all
// others in proportion. Throws Error where it has one point alone, or where the range is so narrow
// that three of them would get one value.
TransferFunction stretched(const TransferFunction& transfer_function, const ValueRange& range);

// The function with the colours of a map, which is spread from its first to its last point unless
// it is one of data values (Colormap::own_range). A function of one point gets the colour in the
// middle.
TransferFunction recolored(const TransferFunction& transfer_function, Colormap colormap);

}  // namespace lamina

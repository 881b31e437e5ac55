// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/transfer_function.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The range of a scalar as it is drawn, lo < hi: wider than it is where it is one value, and a
// little more where the transfer function has a step at its end, whose later side counts.
ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range);

}  // namespace lamina

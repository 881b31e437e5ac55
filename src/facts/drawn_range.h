// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/transfer_function.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The range of a scalar as it is drawn, lo < hi. It is widened where all values are the same, and a
// little where the transfer function has a step at its end, because the later side of the step
// counts there.
ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range);

}  // namespace lamina

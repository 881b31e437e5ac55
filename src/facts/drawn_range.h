// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The range of a scalar as it is drawn, lo < hi. It is widened where all values are the same, and a
// little where the transfer function has a step at its end, because the later side of the step
// counts there.
ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range);

// The range that exact segments normalise to [0, 1]. It holds all values at which something visible
// changes, with a margin; beyond it the transfer function is constant or shows nothing. Samples
// may lie far outside it: a few odd values must not take the digits of those that show. Its width
// is a power of two, and of samples that are whole numbers its lower end is one, so that in float32
// samples stay exact: cells whose value is a step lie on the side of that value.
ValueRange exact_range(const TransferFunction& transfer_function, const ValueRange& range,
                       SampleType type);

// The range that whole tets normalise to [0, 1]: all values at which something visible changes,
// with a margin, cut to the drawn range. Beyond it the transfer function is constant, or there are
// no values. It is the drawn range if nothing visible changes there. `values`: at the mesh's
// points, with `range` as the range of the finite ones. They say how wide the window of a single
// step is.
ValueRange mesh_window(const TransferFunction& transfer_function, std::span<const double> values,
                       const ValueRange& range);

// The largest component of a colour in a range.
double largest_color(const TransferFunction& transfer_function, const ValueRange& range);

// A sample with `range` as [0, 1], as textures of floats hold it. NaN where it is not finite;
// clamped far outside the range.
float normalised_sample(double value, const ValueRange& range);

}  // namespace lamina

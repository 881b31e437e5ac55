// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Returns the range of a scalar as it is drawn, lo < hi. It is widened if all values are equal, and
// a little if the transfer function has a step at its end, because the later side of the step
// counts there.
ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range);

// Returns the range that exact segments normalise to [0, 1]. It holds all values at which something
// visible changes, with a margin; beyond it the transfer function is constant or shows nothing.
// Samples may lie far outside it: a few odd values must not take the digits of the visible ones.
// Its width is a power of two, and its lower end is whole if the samples are, so that samples stay
// exact in float32: cells whose value is a step lie on the side of that value.
ValueRange exact_range(const TransferFunction& transfer_function, const ValueRange& range,
                       SampleType type);

// Returns the range that whole tets normalise to [0, 1]: all values at which something visible
// changes, with a margin, cut to the drawn range. Beyond it the transfer function is constant, or
// there are no values. If nothing visible changes it is the drawn range. `values`: at the mesh's
// points; they decide how wide the window of a single step is. `range`: of the finite ones.
ValueRange mesh_window(const TransferFunction& transfer_function, std::span<const double> values,
                       const ValueRange& range);

// Returns the largest component of a colour in a range.
double largest_color(const TransferFunction& transfer_function, const ValueRange& range);

// Maps a sample from `range` to [0, 1], as textures of floats hold it. NaN if it is not finite;
// clamped far outside the range.
float normalised_sample(double value, const ValueRange& range);

}  // namespace lamina

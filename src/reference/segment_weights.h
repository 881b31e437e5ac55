// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/segment_integral.h"

namespace lamina {

// piece_weights(), with the points of its Gauss rules in vectors. That is for the tracer alone: its
// last digits depend on the instruction set, which those of the tables that pictures are drawn from
// must not.
PieceWeights segment_weights(double p, double q);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// The pieces of a transfer function, fewer where its points stand for a smooth curve.
#pragma once

#include <vector>

#include "optics/linear_pieces.h"

namespace lamina {

// How far a curve may be from the straight pieces that it replaces, of their extinction. Slopes of
// opacity lie within opacity_slope_tolerance on both sides of theirs.
inline constexpr double curve_tolerance = 1.3e-3;
// What this may cost a channel, in 1/255 and for colours up to 1 (docs/precision.md, "Opacity that
// is linear").
inline constexpr double largest_curve_error = 255 * curve_tolerance / 2;

// At the share u of the way through the piece the extinction is that of the straight line plus
// u (1 - u) (bend[0] + u bend[1]); it is > 0 inside the piece where any bend is not 0. Colour is
// linear.
struct CurvedPiece : LinearPiece {
    double bend[2] = {0, 0};
};

// The pieces from lo up to hi. `curved`: those that meet at smooth points become one where a cubic
// keeps to curve_tolerance and colour is linear; otherwise all are straight.
std::vector<CurvedPiece> pieces_between(const TransferFunction& transfer_function, double lo,
                                        double hi, bool curved);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// The pieces of a transfer function, fewer if its points stand for a smooth curve.
#pragma once

#include <vector>

#include "optics/linear_pieces.h"

namespace lamina {

// Largest distance of a curve from the straight pieces that it replaces, as a share of their
// extinction. Curves of slopes of opacity stay within opacity_slope_tolerance on both sides of
// these pieces.
inline constexpr double curve_tolerance = 1.3e-3;
// Error that curve_tolerance may cause in a channel, in 1/255, for colours up to 1
// (docs/precision.md, "Opacity that is linear").
inline constexpr double largest_curve_error = 255 * curve_tolerance / 2;

// A piece whose extinction is cubic: at the share u of the way through the piece it is that of the
// straight line plus u (1 - u) (bend[0] + u bend[1]). It is > 0 inside the piece if any bend is not
// 0. Colour is linear.
struct CurvedPiece : LinearPiece {
    double bend[2] = {0, 0};
};

// Returns the pieces from lo up to hi. `curved`: pieces that meet at smooth points are replaced by
// one if a cubic keeps to curve_tolerance and colour is linear; otherwise all are straight.
std::vector<CurvedPiece> pieces_between(const TransferFunction& transfer_function, double lo,
                                        double hi, bool curved);

}  // namespace lamina

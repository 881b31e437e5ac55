// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "optics/transfer_function.h"

namespace lamina {

// The extinction of a transfer function over [lo, hi] as linear pieces of positive width, and its
// mean over a straight run of the scalar in closed form. Twin of
// shaders/optics/mean_extinction.glsl, which has the scalars as [0, 1].
class ExtinctionPieces {
  public:
    // lo < hi. Extinctions beyond 1e30 are cut to that: float32 holds their products with lengths.
    ExtinctionPieces(const TransferFunction& transfer_function, double lo, double hi);

    struct Piece {
        double left, right;  // (scalar - lo) / (hi - lo)
        double at_left;      // extinction
        double slope;        // its change per unit of left and right
    };
    const std::vector<Piece>& pieces() const { return pieces_; }

    // Mean over the run between two scalars; at the later side of a step for a run of no width.
    double mean(double front, double back) const;

  private:
    double lo_, width_;
    std::vector<Piece> pieces_;
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// What makes piece_weights(p, q).front (optics/segment_integral.h) cheap, and with it colour on one
// linear piece, whatever the transfer function. Twins of shaders/optics/linear_segment.glsl. Along
// a ray their errors add up to no more than so much times the changes of its colour.

// A polynomial for p, q >= 0 of optical depth (p + q) / 2 up to thin_depth: off by at most 3e-5
// there. At most the piece's opacity.
inline constexpr double thin_depth = 1.5;
double thin_front_weight(double p, double q);

// A shorter one, for optical depths up to faint_depth: off by at most 3e-7 there.
inline constexpr double faint_depth = 0.2;
double faint_front_weight(double p, double q);

// A table for all depths, looked up bilinearly. Nodes are equally spaced in p / (1 + p) and
// 1 - 1 / sqrt(1 + q): the weight is smooth in both, linear at 0, and falls to 1 as 1 / p and as
// 1 / sqrt(q). Off by at most 2e-5 where p and q are below 20, and by 5e-4 anywhere; for faint
// pieces by 2.2e-3 of their opacity.
class FrontWeightTable {
  public:
    static constexpr int nodes = 256;

    static const FrontWeightTable& get();  // built at the first call

    // nodes * nodes, index row * nodes + column: by column p, by row q.
    const std::vector<float>& texels() const { return texels_; }
    // p, q >= 0; at most the piece's opacity.
    double lookup(double p, double q) const;

  private:
    FrontWeightTable();

    std::vector<float> texels_;
};

}  // namespace lamina

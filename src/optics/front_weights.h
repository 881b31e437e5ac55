// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// Fast approximations of piece_weights(p, q).front (optics/segment_integral.h), from which the
// colour of one linear piece follows for every transfer function. They have twins in
// shaders/optics/linear_segment.glsl. The colour of a ray is off by at most the error given below
// times the sum of the ray's changes of colour.

// A polynomial for p, q >= 0 and an optical depth (p + q) / 2 up to thin_depth. Its error is at
// most 3e-5 there, and its value is at most the piece's opacity.
inline constexpr double thin_depth = 1.5;
double thin_front_weight(double p, double q);

// A shorter polynomial for optical depths up to faint_depth. Its error is at most 3e-7 there.
inline constexpr double faint_depth = 0.2;
double faint_front_weight(double p, double q);

// A table for all depths, interpolated bilinearly. Nodes are equally spaced in p / (1 + p) and 1 -
// 1 / sqrt(1 + q). The weight is smooth in both, linear at 0, and approaches 1 as 1 / p and as 1 /
// sqrt(q). The error is at most 2e-5 if p and q are below 20, and 5e-4 anywhere; for pieces of
// small optical depth it is at most 2.2e-3 of their opacity.
class FrontWeightTable {
  public:
    static constexpr int nodes = 256;

    static const FrontWeightTable& get();  // built at the first call

    // nodes * nodes values, index row * nodes + column: columns by p, rows by q.
    const std::vector<float>& texels() const { return texels_; }
    // p, q >= 0. The result is at most the piece's opacity.
    double lookup(double p, double q) const;

  private:
    FrontWeightTable();

    std::vector<float> texels_;
};

}  // namespace lamina

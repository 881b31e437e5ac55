// SPDX-License-Identifier: Apache-2.0
#include "optics/front_weights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "optics/opacity.h"
#include "optics/segment_integral.h"

namespace lamina {
namespace {

constexpr double opaque = 1e30;  // stands for the infinite optical depth of the last node.

std::size_t texel_index(int column, int row) {
    return static_cast<std::size_t>(row) * FrontWeightTable::nodes +
           static_cast<std::size_t>(column);
}

}  // namespace

// Minimax polynomial of degree 3 over the triangle p, q >= 0, p + q <= 2 faint_depth, found by
// iterated least squares.
double faint_front_weight(double p, double q) {
    const double pq = -0.07483143 + 0.01593537 * p + 0.01098378 * q;
    const double of_p = 0.33332185 + p * (-0.06649057 + p * 0.00875053) + q * pq;
    const double of_q = 0.166663 + q * (-0.02493882 + q * 0.00273092);
    return std::min(p * of_p + q * of_q, opacity_from_depth(p / 2 + q / 2));
}

// The minimax polynomial of degree 4 over the triangle p, q >= 0, p + q <= 2 thin_depth, found by
// iterated least squares.
double thin_front_weight(double p, double q) {
    const double c0 = q * (0.166777794 + q * (-0.025093103 + q * (0.002890381 - q * 0.000196459)));
    const double c1 = 0.333037217 + q * (-0.074477034 + q * (0.011162302 - q * 0.000919007));
    const double c2 = -0.065656503 + q * (0.015676728 - q * 0.001696676);
    const double c3 = 0.008428908 - q * 0.001502640;
    const double c4 = -0.000561545;
    const double weight = c0 + p * (c1 + p * (c2 + p * (c3 + p * c4)));
    return std::min(weight, opacity_from_depth(p / 2 + q / 2));
}

const FrontWeightTable& FrontWeightTable::get() {
    static const FrontWeightTable table;
    return table;
}

FrontWeightTable::FrontWeightTable() : texels_(std::size_t{nodes} * nodes) {
    for (int row = 0; row < nodes; ++row) {
        const double y = static_cast<double>(row) / (nodes - 1);
        const double q = std::min(1 / ((1 - y) * (1 - y)) - 1, opaque);
        for (int column = 0; column < nodes; ++column) {
            const double x = static_cast<double>(column) / (nodes - 1);
            const double p = std::min(x / (1 - x), opaque);
            texels_[texel_index(column, row)] = static_cast<float>(piece_weights(p, q).front);
        }
    }
}

double FrontWeightTable::lookup(double p, double q) const {
    p = std::min(p, opaque);
    q = std::min(q, opaque);
    // This form has no difference, so that faint segments keep their digits.
    const double root = std::sqrt(1 + q);
    const double x = (nodes - 1) * (p / (1 + p));
    const double y = (nodes - 1) * (q / root / (1 + root));
    const int column = std::min(static_cast<int>(x), nodes - 2);
    const int row = std::min(static_cast<int>(y), nodes - 2);
    const double right = x - column, down = y - row;
    const auto texel = [&](int i, int j) {
        return static_cast<double>(texels_[texel_index(column + i, row + j)]);
    };
    const double weight = (1 - down) * ((1 - right) * texel(0, 0) + right * texel(1, 0)) +
                          down * ((1 - right) * texel(0, 1) + right * texel(1, 1));
    return std::min(weight, opacity_from_depth(p / 2 + q / 2));
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_integral.h"

#include <cerf.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "optics/gauss_rules.h"
#include "optics/linear_pieces.h"
#include "optics/opacity.h"

namespace lamina {

namespace {

// Limit of a piece's optical depth, so that sums of depths stay finite.
constexpr double largest_depth = 1e300;

// docs/numerics.md, section 5, with u(x) = px + kx^2, the depth from the front to x: front = 1 - G
// = int 1 - exp(-u) and back = G - exp(-D) = int exp(-u) (1 - exp(-(D - u))). u and D - u are
// written without subtractions that could cancel, so every term of both sums is >= 0 and accurate
// for every p and q, however small.
PieceWeights quadrature_weights(const GaussRule& rule, double p, double q) {
    PieceWeights weights;
    for (std::size_t i = 0; i < rule.points; ++i) {
        const double x = rule.x[i], weight = rule.weight[i];
        const double before = x * (p * (1 - x / 2) + q * x / 2);
        const double behind = (1 - x) * (p * (1 - x) / 2 + q * (1 + x) / 2);
        const double absorbed = opacity_from_depth(before);
        weights.front += weight * absorbed;
        weights.back += weight * (1 - absorbed) * opacity_from_depth(behind);
    }
    return weights;
}

// Returns G of docs/numerics.md, section 5, for D >= 4. Neither 1 - G nor G - exp(-D) cancels
// there.
double mean_transmittance(double p, double q) {
    const double depth = p / 2 + q / 2;
    const double k = (q - p) / 2;
    const double root = std::sqrt(std::abs(k));
    // For k -> 0 the closed forms below keep their accuracy until p / root overflows. k <= 1e-17 D
    // changes nothing.
    if (std::abs(k) <= 1e-17 * depth) return opacity_from_depth(depth) / depth;
    const double front = p / (2 * root);
    const double back = q / (2 * root);
    const double transmittance = std::exp(-depth);
    if (k > 0) {
        return (erfcx(front) - transmittance * erfcx(back)) / (root * std::numbers::inv_sqrtpi * 2);
    }
    return (dawson(front) - transmittance * dawson(back)) / root;
}

// Returns the place, at most 1, up to which the optical depth is `wanted` < D.
double place_of_depth(double wanted, double p, double q) {
    const double root = std::sqrt(std::max(p * p + 2 * (q - p) * wanted, 0.0));
    return std::min(2 * wanted / (p + root), 1.0);
}

// Adds optical depths with their rounding errors (compensated summation), so that exp(-depth) stays
// accurate behind many pieces.
class DepthSum {
  public:
    void add(double depth) {
        const double sum = sum_ + depth;
        const double taken = sum - sum_;
        error_ += (sum_ - (sum - taken)) + (depth - taken);
        sum_ = sum;
    }
    double value() const { return sum_ + error_; }
    double transmittance() const { return std::exp(-sum_) * std::exp(-error_); }

  private:
    double sum_ = 0;
    double error_ = 0;
};

}  // namespace

PieceWeights piece_weights(double p, double q) {
    const double depth = p / 2 + q / 2;
    if (depth < largest_gauss_depth) return quadrature_weights(gauss_rule(depth), p, q);
    const double g = mean_transmittance(p, q);
    return {1 - g, g - std::exp(-depth)};
}

// Integration by parts gives the integral of 2 (1 - x) (1 - exp(-u)). Beyond a depth of 20, exp(-u)
// is below 2e-9; up to there the error of 16 points is less than that.
double front_moment(double p, double q) {
    constexpr double deep = 20;
    const double depth = p / 2 + q / 2;
    const double seen = depth > deep ? place_of_depth(deep, p, q) : 1;
    const GaussRule& rule = gauss_rule(depth);
    double sum = 0;
    for (std::size_t i = 0; i < rule.points; ++i) {
        const double x = seen * rule.x[i];
        const double before = x * (p * (1 - x / 2) + q * x / 2);
        sum += rule.weight[i] * 2 * (1 - x) * opacity_from_depth(before);
    }
    return seen * sum + (1 - seen) * (1 - seen);
}

namespace {

glm::dvec3 piece_color(const LinearPiece& piece, double p, double q) {
    // Most pieces of palettes have one colour; its weight is the opacity.
    if (piece.at_from.color == piece.at_to.color) {
        return opacity_from_depth(p / 2 + q / 2) * piece.at_from.color;
    }
    const PieceWeights weights = piece_weights(p, q);
    return weights.front * piece.at_from.color + weights.back * piece.at_to.color;
}

}  // namespace

SegmentIntegral integrate_segment(const TransferFunction& transfer_function, double front,
                                  double back, double length) {
    SegmentIntegral result;
    if (!(length > 0)) return result;
    DepthSum depth;
    for_each_linear_piece(transfer_function.knots(), front, back, [&](const LinearPiece& piece) {
        // Both differences are of the numbers given, so the share is accurate however close front
        // and back are.
        const double share = front == back ? 1 : (piece.to - piece.from) / (back - front);
        const double part = length * share;
        const double p = std::min(part * piece.at_from.extinction, largest_depth);
        const double q = std::min(part * piece.at_to.extinction, largest_depth);
        if (p == 0 && q == 0) return;
        const double transmittance = depth.transmittance();
        if (transmittance > 0) result.color += transmittance * piece_color(piece, p, q);
        depth.add(p / 2 + q / 2);
    });
    result.optical_depth = depth.value();
    result.alpha = opacity_from_depth(result.optical_depth);
    return result;
}

}  // namespace lamina

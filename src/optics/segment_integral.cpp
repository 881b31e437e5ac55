// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_integral.h"

#include <cerf.h>
#include <numbers>

#include "base/arithmetic.h"
#include "optics/opacity.h"
#include "optics/pieces.h"

namespace lamina {
namespace {

// Limits a piece's optical depth, so that sums of depths stay finite.
constexpr double largest_depth = 1e300;

// Integrates over x in [0, 1] (docs/numerics.md, section 5), with u(x) = px + kx^2 and D = u(1):
// front = int 1 - exp(-u), back = int exp(-u) (1 - exp(-(D - u))). Neither u nor D - u is computed
// as a difference: every term is >= 0 and accurate.
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

// Returns G, the mean transmittance in front of a place in the piece (docs/numerics.md, section 5),
// for D >= 4: neither 1 - G nor G - exp(-D) cancels then.
double mean_transmittance(double p, double q) {
    const double depth = p / 2 + q / 2;
    const double k = (q - p) / 2;
    const double root = std::sqrt(std::abs(k));
    // If k <= 1e-17 D, extinction is constant; above, closed forms hold until p / root overflows.
    if (std::abs(k) <= 1e-17 * depth) return opacity_from_depth(depth) / depth;
    const double front = p / (2 * root);
    const double back = q / (2 * root);
    const double transmittance = std::exp(-depth);
    if (k > 0) {
        return (erfcx(front) - transmittance * erfcx(back)) / (root * std::numbers::inv_sqrtpi * 2);
    }
    return (dawson(front) - transmittance * dawson(back)) / root;
}

// Returns the x, at most 1, up to which the optical depth is `wanted` < D.
double place_of_depth(double wanted, double p, double q) {
    const double root = std::sqrt(std::max(p * p + 2 * (q - p) * wanted, 0.0));
    return std::min(2 * wanted / (p + root), 1.0);
}

glm::dvec3 piece_color(const LinearPiece& piece, double p, double q) {
    // Palettes have mostly pieces of one colour, whose weight is the opacity.
    if (piece.at_from.color == piece.at_to.color) {
        return opacity_from_depth(p / 2 + q / 2) * piece.at_from.color;
    }
    const PieceWeights weights = piece_weights(p, q);
    return weights.front * piece.at_from.color + weights.back * piece.at_to.color;
}

constexpr double opaque = 1e30;  // stands for p or q of the last node, which is infinite

std::size_t texel_index(int column, int row) {
    return std::size_t{FrontWeightTable::nodes} * row + column;
}

}  // namespace

PieceWeights piece_weights(double p, double q) {
    const double depth = p / 2 + q / 2;
    if (depth < largest_gauss_depth) return quadrature_weights(gauss_rule(depth), p, q);
    const double g = mean_transmittance(p, q);
    return {1 - g, g - std::exp(-depth)};
}

// By parts it is the integral of 2 (1 - x) (1 - exp(-u)). If u > 20, exp(-u) < 2.1e-9 counts as 0.
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

SegmentIntegral integrate_segment(const TransferFunction& transfer_function, double front,
                                  double back, double length) {
    SegmentIntegral result;
    if (!(length > 0)) return result;
    DoubleDouble depth;  // compensated, so that exp(-depth) stays accurate behind many pieces
    for_each_linear_piece(transfer_function.knots(), front, back, [&](const LinearPiece& piece) {
        // The scalars are given exactly, so both differences, and the share, are accurate.
        const double share = front == back ? 1 : (piece.to - piece.from) / (back - front);
        const double part = length * share;
        const double p = std::min(part * piece.at_from.extinction, largest_depth);
        const double q = std::min(part * piece.at_to.extinction, largest_depth);
        if (p == 0 && q == 0) return;
        const double transmittance = std::exp(-depth.hi) * std::exp(-depth.lo);
        if (transmittance > 0) result.color += transmittance * piece_color(piece, p, q);
        const DoubleDouble sum = exact_sum(depth.hi, p / 2 + q / 2);
        depth = {sum.hi, depth.lo + sum.lo};
    });
    result.optical_depth = depth.rounded();
    result.alpha = opacity_from_depth(result.optical_depth);
    return result;
}

// The light factor on the piece is to_left + width * (1 - x), with x from 0 to 1.
FrontParts front_parts_of(const SegmentPiece& piece) {
    const double p = std::min(piece.length * piece.front.extinction, largest_depth);
    const double q = std::min(piece.length * piece.back.extinction, largest_depth);
    if (p == 0 && q == 0) return {};
    const double to_left = 1 - piece.to, width = piece.to - piece.from;
    const PieceWeights once = piece_weights(p, q);
    const double twice = front_moment(p, q);
    const double of_front = to_left * once.front + width * twice;
    const double of_back = to_left * once.back + width * std::max(once.front - twice, 0.0);
    return {of_front + of_back, of_front * piece.front.color + of_back * piece.back.color};
}

LitIntegral integrate_lit_segment(const TransferFunction& transfer_function, double front,
                                  double back, double length) {
    LitIntegral result;
    result.whole = integrate_segment(transfer_function, front, back, length);
    if (!(length > 0)) return result;
    double depth = 0;
    for_each_linear_piece(transfer_function.knots(), front, back, [&](const LinearPiece& piece) {
        SegmentPiece lit{piece.at_from, piece.at_to, length, 0, 1};
        if (front != back) {
            lit.from = (piece.from - front) / (back - front);
            lit.to = (piece.to - front) / (back - front);
            lit.length = length * ((piece.to - piece.from) / (back - front));
        }
        const FrontParts parts = front_parts_of(lit);
        const double transmittance = std::exp(-depth);
        result.front.alpha += transmittance * parts.alpha;
        result.front.color += transmittance * parts.color;
        depth += lit.length * (piece.at_from.extinction / 2 + piece.at_to.extinction / 2);
    });
    return result;
}

// Polynomial of degree 3, minimax over p, q >= 0, p + q <= 2 faint_depth: iterated least squares.
double faint_front_weight(double p, double q) {
    const double pq = -0.07483143 + 0.01593537 * p + 0.01098378 * q;
    const double of_p = 0.33332185 + p * (-0.06649057 + p * 0.00875053) + q * pq;
    const double of_q = 0.166663 + q * (-0.02493882 + q * 0.00273092);
    return std::min(p * of_p + q * of_q, opacity_from_depth(p / 2 + q / 2));
}

// Polynomial of degree 4, minimax over p, q >= 0, p + q <= 2 thin_depth: iterated least squares.
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
    // Nodes as in the constructor, without a subtraction, so that small p and q keep their digits.
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

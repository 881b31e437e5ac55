// SPDX-License-Identifier: Apache-2.0
#include "optics/extinction_pieces.h"

#include <algorithm>

#include "optics/linear_pieces.h"

namespace lamina {
namespace {

constexpr double most_extinction = 1e30;

// Runs are taken at least so wide, of [lo, hi]: float32 still resolves it.
constexpr double least_width = 1.0 / (1 << 21);

}  // namespace

ExtinctionPieces::ExtinctionPieces(const TransferFunction& transfer_function, double lo, double hi)
    : lo_(lo), width_(hi - lo) {
    const auto place = [&](double scalar) { return (scalar - lo_) / width_; };
    for_each_linear_piece(transfer_function.knots(), lo, hi, [&](const LinearPiece& piece) {
        const double left = place(piece.from), right = place(piece.to);
        if (!(left < right)) return;
        const double at_left = std::min(piece.at_from.extinction, most_extinction);
        const double at_right = std::min(piece.at_to.extinction, most_extinction);
        pieces_.push_back({left, right, at_left, (at_right - at_left) / (right - left)});
    });
}

double ExtinctionPieces::mean(double front, double back) const {
    const double a_place = std::clamp((front - lo_) / width_, 0.0, 1.0);
    const double b_place = std::clamp((back - lo_) / width_, 0.0, 1.0);
    const double from = std::min(std::min(a_place, b_place), 1 - least_width);
    const double to = std::max(std::max(a_place, b_place), from + least_width);
    double sum = 0;
    for (const Piece& piece : pieces_) {
        const double a = std::clamp(from, piece.left, piece.right);
        const double b = std::clamp(to, piece.left, piece.right);
        sum += (b - a) * (piece.at_left + piece.slope * (0.5 * (a + b) - piece.left));
    }
    return std::max(sum, 0.0) / (to - from);
}

}  // namespace lamina

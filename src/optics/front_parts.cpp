// SPDX-License-Identifier: Apache-2.0
#include "optics/front_parts.h"

#include <algorithm>
#include <cmath>

#include "optics/linear_pieces.h"

namespace lamina {
namespace {

constexpr double largest_depth = 1e300;  // so that sums of two stay finite

}  // namespace

// On the piece the factor is to_left + width * (1 - x), with x from 0 to 1.
FrontParts front_parts_of(const SegmentStretch& piece) {
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
        SegmentStretch lit{piece.at_from, piece.at_to, length, 0, 1};
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

}  // namespace lamina

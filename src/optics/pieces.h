// SPDX-License-Identifier: Apache-2.0
// The linear pieces of a transfer function between two scalars.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina {

// Interpolates colour and extinction at `value` on the straight line between two knots of different
// value. Every term is >= 0, so nothing cancels, and equal ends give exactly their value.
inline OpticalProperties interpolate(const TransferKnot& a, const TransferKnot& b, double value) {
    const double width = b.value - a.value;
    const double weight_a = (b.value - value) / width;
    const double weight_b = (value - a.value) / width;
    const auto mix = [&](double at_a, double at_b) {
        return at_a == at_b ? at_a : at_a * weight_a + at_b * weight_b;
    };
    OpticalProperties result;
    for (int c = 0; c < 3; ++c) result.color[c] = mix(a.optics.color[c], b.optics.color[c]);
    result.extinction = mix(a.optics.extinction, b.optics.extinction);
    return result;
}

struct LinearPiece {
    double from = 0, to = 0;  // scalars, in walking order
    OpticalProperties at_from, at_to;
};

// Returns colour and extinction in one piece. With n knots there are n + 1 pieces: piece j lies
// between knots j - 1 and j; the first and the last are constant, outside the knots.
inline OpticalProperties optics_in_piece(std::span<const TransferKnot> knots, std::size_t piece,
                                         double value) {
    if (piece == 0) return knots.front().optics;
    if (piece == knots.size()) return knots.back().optics;
    return interpolate(knots[piece - 1], knots[piece], value);
}

// Calls visit(piece) for the pieces of positive width from `front` to `back`, in that order. For
// front == back it is called once, with a piece of no width that has at(front) at both ends.
template <typename Visit>
void for_each_linear_piece(std::span<const TransferKnot> knots, double front, double back,
                           const Visit& visit) {
    const auto value_of = [](const TransferKnot& knot) { return knot.value; };
    const auto emit = [&](std::size_t j, double from, double to) {
        visit(
            LinearPiece{from, to, optics_in_piece(knots, j, from), optics_in_piece(knots, j, to)});
    };
    if (front < back || front == back) {
        const auto above = std::ranges::upper_bound(knots, front, {}, value_of);
        auto j = static_cast<std::size_t>(above - knots.begin());
        if (front == back) return emit(j, front, back);
        for (double from = front; from < back; ++j) {
            const double to = j < knots.size() ? std::min(knots[j].value, back) : back;
            if (to > from) emit(j, from, to);
            from = to;
        }
    } else {
        const auto not_below = std::ranges::lower_bound(knots, front, {}, value_of);
        auto j = static_cast<std::size_t>(not_below - knots.begin());
        for (double from = front; from > back; --j) {
            const double to = j > 0 ? std::max(knots[j - 1].value, back) : back;
            if (to < from) emit(j, from, to);
            from = to;
        }
    }
}

// Returns the colour at the first place of [lo, hi] with extinction > 0; black if there is none.
inline glm::dvec3 first_color(const TransferFunction& transfer_function, double lo, double hi) {
    glm::dvec3 color(0);
    bool found = false;
    for_each_linear_piece(transfer_function.knots(), lo, hi, [&](const LinearPiece& piece) {
        if (found) return;
        found = piece.at_from.extinction > 0 || piece.at_to.extinction > 0;
        if (found) color = piece.at_from.color;
    });
    return color;
}

// The pieces of a transfer function, fewer if its points stand for a smooth curve.

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

// SPDX-License-Identifier: Apache-2.0
// The linear pieces of a transfer function between two scalars.
#pragma once

#include <algorithm>
#include <cstddef>

#include "lamina/transfer_function.h"

namespace lamina {

// Interpolates between knots of different value, without cancellation; equal properties stay exact.
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
    double from = 0, to = 0;  // scalars: where the piece is entered, and where it is left
    OpticalProperties at_from, at_to;
};

// Visits the pieces from `front` to `back` in order; if both are equal, one piece of no width.
template <typename Visit>
void for_each_linear_piece(std::span<const TransferKnot> knots, double front, double back,
                           const Visit& visit) {
    const auto value_of = [](const TransferKnot& knot) { return knot.value; };
    // Piece j lies between knots j - 1 and j; the first and the last are constant.
    const auto emit = [&](std::size_t j, double from, double to) {
        const auto at = [&](double value) {
            if (j == 0) return knots.front().optics;
            if (j == knots.size()) return knots.back().optics;
            return interpolate(knots[j - 1], knots[j], value);
        };
        visit(LinearPiece{from, to, at(from), at(to)});
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

// Returns the colour at the lower end of the first piece in [lo, hi] with extinction, or black.
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

// Largest distance of a cubic from the straight pieces that it replaces, as a share of extinction:
// large enough for pieces that stand for opacity slopes (within opacity_slope_tolerance of these).
inline constexpr double curve_tolerance = 1.3e-3;
// Largest error by such a curve, in 1/255 (docs/precision.md, "Opacity that is linear").
inline constexpr double largest_curve_error = 255 * curve_tolerance / 2;

// A piece with linear colour. Its extinction may be a cubic in its share u, 0 at `from`, 1 at `to`:
// the line plus u (1 - u) (bend[0] + u bend[1]). If any bend is not 0, it is > 0 inside.
struct CurvedPiece : LinearPiece {
    double bend[2] = {0, 0};
};

// Returns the pieces between the scalars lo and hi. `curved`: from lo on, one cubic replaces as
// many pieces joined at smooth points as it follows within curve_tolerance.
std::vector<CurvedPiece> pieces_between(const TransferFunction& transfer_function, double lo,
                                        double hi, bool curved);

}  // namespace lamina

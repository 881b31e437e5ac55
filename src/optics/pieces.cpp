// SPDX-License-Identifier: Apache-2.0
#include "optics/pieces.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <span>

namespace lamina {

namespace {

// Number of pieces that one cubic may replace. It bounds the time of the search; curves bend too
// much over more pieces than this.
constexpr std::size_t most_merged = 64;
// Distance from a straight line below which colours (1 is full scale) count as linear: the digits
// of a float.
constexpr double color_tolerance = 1e-6;

// Extinctions above this are not replaced by curves, because bends must fit into floats.
constexpr double largest_extinction = 1e30;

using Pieces = std::span<const CurvedPiece>;

// Tells whether the knot at `value` is smooth. A step is not: it has a knot on each side.
bool smooth_at(std::span<const TransferKnot> knots, double value) {
    const auto knot = std::ranges::lower_bound(knots, value, {}, &TransferKnot::value);
    if (knot == knots.end() || knot->value != value) return false;
    const auto next = knot + 1;
    return knot->smooth && (next == knots.end() || next->value != value);
}

bool colors_are_linear(Pieces pieces, const CurvedPiece& all) {
    for (const CurvedPiece& piece : pieces.subspan(1)) {
        const double share = (piece.from - all.from) / (all.to - all.from);
        const glm::dvec3 line = glm::mix(all.at_from.color, all.at_to.color, share);
        for (int c = 0; c < 3; ++c) {
            if (std::abs(line[c] - piece.at_from.color[c]) > color_tolerance) return false;
        }
    }
    return true;
}

// Calls visit(share of all, extinction) for sample places in each piece, closer together if the
// pieces are short.
template <typename Visit>
void for_each_place(Pieces pieces, const CurvedPiece& all, const Visit& visit) {
    constexpr int places = 4;
    for (const CurvedPiece& piece : pieces) {
        for (int i = 0; i < places; ++i) {
            const double within = static_cast<double>(i) / places;
            const double value = piece.from + (piece.to - piece.from) * within;
            const double extinction =
                glm::mix(piece.at_from.extinction, piece.at_to.extinction, within);
            visit((value - all.from) / (all.to - all.from), extinction);
        }
    }
}

// Returns the cubic that replaces these pieces, by least squares of the relative error; nothing if
// that error is too large.
std::optional<CurvedPiece> merged(Pieces pieces) {
    CurvedPiece all{
        {pieces.front().from, pieces.back().to, pieces.front().at_from, pieces.back().at_to}};
    if (std::max(all.at_from.extinction, all.at_to.extinction) > largest_extinction) return {};
    if (!colors_are_linear(pieces, all)) return {};
    const double left = all.at_from.extinction, change = all.at_to.extinction - left;
    double a = 0, b = 0, c = 0, d = 0, e = 0;
    for_each_place(pieces, all, [&](double u, double extinction) {
        if (!(extinction > 0)) return;
        const double p = u * (1 - u) / extinction, q = p * u;
        const double wanted = (extinction - left - change * u) / extinction;
        a += p * p;
        b += p * q;
        c += q * q;
        d += p * wanted;
        e += q * wanted;
    });
    const double determinant = a * c - b * b;
    if (!(determinant > 0)) return {};
    all.bend[0] = (c * d - b * e) / determinant;
    all.bend[1] = (a * e - b * d) / determinant;
    bool near = std::isfinite(all.bend[0]) && std::isfinite(all.bend[1]);
    for_each_place(pieces, all, [&](double u, double extinction) {
        if (u == 0) return;
        const double curve = left + u * (change + (1 - u) * (all.bend[0] + u * all.bend[1]));
        near =
            near && extinction > 0 && std::abs(curve - extinction) <= curve_tolerance * extinction;
    });
    if (near) return all;
    return {};
}

}  // namespace

std::vector<CurvedPiece> pieces_between(const TransferFunction& transfer_function, double lo,
                                        double hi, bool curved) {
    std::vector<CurvedPiece> straight;
    const auto knots = transfer_function.knots();
    for_each_linear_piece(knots, lo, hi,
                          [&](const LinearPiece& piece) { straight.push_back({piece}); });
    if (!curved) return straight;
    std::vector<CurvedPiece> pieces;
    for (std::size_t i = 0; i < straight.size();) {
        CurvedPiece piece = straight[i];
        std::size_t count = 1;
        while (i + count < straight.size() && count < most_merged &&
               smooth_at(knots, straight[i + count].from)) {
            const auto longer = merged(Pieces(straight).subspan(i, count + 1));
            if (!longer) break;
            piece = *longer;
            ++count;
        }
        pieces.push_back(piece);
        i += count;
    }
    return pieces;
}

}  // namespace lamina

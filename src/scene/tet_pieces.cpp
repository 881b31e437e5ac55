// SPDX-License-Identifier: Apache-2.0
#include "scene/tet_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace lamina {

TetPieces::TetPieces(const TransferFunction& transfer_function, const ValueRange& range) {
    for_each_linear_piece(
        transfer_function.knots(), range.lo, range.hi, [&](const LinearPiece& piece) {
            pieces_.push_back(piece);
            transparent_.push_back(piece.at_from.extinction == 0 && piece.at_to.extinction == 0);
        });
}

TetPieces::Span TetPieces::visible(std::span<const double> scalar, const Tet& tet) const {
    double lo = INFINITY, hi = -INFINITY;
    for (const std::int32_t corner : tet) {
        const double value = scalar[static_cast<std::size_t>(corner)];
        if (!std::isfinite(value)) return {};
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    // The first that begins above lo lies behind the one that has it, and so does, where the scalar
    // varies, the first that does not end below hi.
    const auto above = std::ranges::upper_bound(pieces_, lo, {}, &LinearPiece::from);
    Span span;
    span.first =
        static_cast<std::int32_t>(std::max<std::ptrdiff_t>(above - pieces_.begin() - 1, 0));
    const auto end = std::ranges::lower_bound(pieces_, hi, {}, &LinearPiece::to);
    const auto last = static_cast<std::int32_t>(
        std::min<std::ptrdiff_t>(end - pieces_.begin(), std::ssize(pieces_) - 1));
    span.last = lo < hi ? last : span.first;
    while (!span.empty() && transparent(span.first)) ++span.first;
    while (!span.empty() && transparent(span.last)) --span.last;
    return span;
}

int TetPieces::count(const Span& span) const {
    int visible = 0;
    for (std::int32_t piece = span.first; piece <= span.last; ++piece)
        visible += !transparent(piece);
    return visible;
}

}  // namespace lamina

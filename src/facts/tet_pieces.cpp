// SPDX-License-Identifier: Apache-2.0
#include "facts/tet_pieces.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "mesh/scalar_range.h"

namespace lamina {

TetPieces::TetPieces(const TransferFunction& transfer_function, const ValueRange& range) {
    for_each_linear_piece(
        transfer_function.knots(), range.lo, range.hi, [&](const LinearPiece& piece) {
            const bool transparent = piece.at_from.extinction == 0 && piece.at_to.extinction == 0;
            if (transparent && !pieces_.empty() && this->transparent(last())) {  // one gap
                pieces_.back().to = piece.to;
                pieces_.back().at_to = piece.at_to;
                return;
            }
            pieces_.push_back(piece);
            visible_before_.push_back(visible_before_.back() + (transparent ? 0 : 1));
        });
}

TetPieces::Span TetPieces::met(std::span<const double> scalar, const Tet& tet) const {
    const ValueRange range = range_in(scalar, tet);
    if (range.empty()) return {};
    const auto [lo, hi] = range;
    // The first piece that begins above lo lies behind the one that has it. If the scalar varies,
    // so does the first that does not end below hi.
    const auto above = std::ranges::upper_bound(pieces_, lo, {}, &LinearPiece::from);
    Span span;
    span.first =
        static_cast<std::int32_t>(std::max<std::ptrdiff_t>(above - pieces_.begin() - 1, 0));
    const auto end = std::ranges::lower_bound(pieces_, hi, {}, &LinearPiece::to);
    const auto last_of_range =
        static_cast<std::int32_t>(std::min<std::ptrdiff_t>(end - pieces_.begin(), last()));
    span.last = lo < hi ? last_of_range : span.first;
    return span;
}

TetPieces::Span TetPieces::visible(std::span<const double> scalar, const Tet& tet) const {
    Span span = met(scalar, tet);
    while (!span.empty() && transparent(span.first)) ++span.first;
    while (!span.empty() && transparent(span.last)) --span.last;
    return span;
}

int TetPieces::count(const Span& span) const {
    if (span.empty()) return 0;
    return visible_before_[static_cast<std::size_t>(span.last) + 1] -
           visible_before_[static_cast<std::size_t>(span.first)];
}

}  // namespace lamina

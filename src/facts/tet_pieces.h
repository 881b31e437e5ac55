// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lamina/tet.h"
#include "optics/pieces.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The first piece that begins above lo lies behind the one that has it. If the scalar varies, so
// does the first that does not end below hi.
class TetPieces {
  public:
    // range: finite, lo < hi.
    TetPieces(const TransferFunction& transfer_function, const ValueRange& range);

    const std::vector<LinearPiece>& pieces() const { return pieces_; }  // ascending
    bool transparent(std::int32_t piece) const {
        const auto place = static_cast<std::size_t>(piece);
        return visible_before_[place] == visible_before_[place + 1];
    }

    // The first and the last of some consecutive pieces; last < first if there are none.
    struct Span {
        std::int32_t first = 0, last = -1;

        bool empty() const { return last < first; }
    };
    // Returns the pieces in which some point of the tet lies; empty if a corner's value is not
    // finite.
    Span met(std::span<const double> scalar, const Tet& tet) const;
    // Returns met() without the transparent pieces at both ends.
    Span visible(std::span<const double> scalar, const Tet& tet) const;
    // The number of pieces in a span that show something.
    int count(const Span& span) const;

  private:
    std::int32_t last() const { return static_cast<std::int32_t>(pieces_.size()) - 1; }

    std::vector<LinearPiece> pieces_;
    // Number of pieces that show something before each piece, and in all.
    std::vector<int> visible_before_{0};
};

}  // namespace lamina

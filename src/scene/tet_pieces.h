// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/tet.h"
#include "optics/linear_pieces.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The linear pieces of a transfer function over a range, and which of them a tet's scalar runs
// through.
class TetPieces {
  public:
    // range: finite, lo <= hi.
    TetPieces(const TransferFunction& transfer_function, const ValueRange& range);

    const std::vector<LinearPiece>& pieces() const { return pieces_; }  // ascending
    bool transparent(int piece) const { return transparent_[static_cast<std::size_t>(piece)] != 0; }

    // Of the pieces that some point of the tet lies in and that show something the first and the
    // last: last < first where there is none, or a corner has a value that is no finite number.
    struct Span {
        std::int32_t first = 0, last = -1;

        bool empty() const { return last < first; }
    };
    Span visible(std::span<const double> scalar, const Tet& tet) const;
    // So many of them show something.
    int count(const Span& span) const;

  private:
    std::vector<LinearPiece> pieces_;
    std::vector<char> transparent_;
};

}  // namespace lamina

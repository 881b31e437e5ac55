// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lamina/mesh.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "optics/pieces.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Returns the range over which a scalar is drawn, lo < hi: `range`, widened if all values are
// equal, and a little if the function has a step at its end, whose later side counts there.
ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range);

// Returns the range that exact segments normalise to [0, 1]: all values at which something visible
// changes, with a margin, so that outliers do not cost these values precision. Its width is a power
// of two and, for integer samples, its lower end an integer, so that samples stay exact in float32,
// and cells of a constant value at a step get the right side of it.
ValueRange exact_range(const TransferFunction& transfer_function, const ValueRange& range,
                       SampleType type);

// Returns the range that tets normalise to [0, 1] unless they are cut at the transfer function's
// points: all values at which something visible changes, with a margin, clipped to drawn_range(),
// or drawn_range() if nothing changes. `values`: the scalars at the mesh's points; they decide the
// width if all that changes is a step. `range`: the range of the finite scalars.
ValueRange mesh_window(const TransferFunction& transfer_function, std::span<const double> values,
                       const ValueRange& range);

double largest_color(const TransferFunction& transfer_function, const ValueRange& range);

// Maps a sample from `range` to [0, 1], clamped far outside; NaN if it is not finite.
float normalised_sample(double value, const ValueRange& range);

// The rest of this file is about tets whose scalar reaches far outside the window that is drawn,
// such as those around a value that marks missing data (docs/precision.md, "Exact segments").

// Distance in widths of the window beyond which a tet's scalar is computed in double precision at
// each fragment: in float32 its error relative to the window grows by this factor.
inline constexpr double far_for_floats = 16;

// Distance in window widths up to which float32 suffices for tets cut into pieces: for a piece as
// wide as a tenth of the window, 128 * 2^-24 of the window is 1e-4 of the piece.
inline constexpr double far_for_parts = 128;

// Distance in window widths up to which float32 can square normalised scalars. Beyond, a tet is
// drawn in a wider window: less than 1e-18 of it lies in the real one.
inline constexpr double farthest_normalised = 0x1p60;

// Tells whether scalars meet the window and also reach more than `far` widths beyond it.
inline bool runs_beyond(const ValueRange& scalars, const ValueRange& window, double far) {
    const double most = far * (window.hi - window.lo);
    return scalars.lo < window.hi && scalars.hi > window.lo &&
           (window.lo - scalars.lo > most || scalars.hi - window.hi > most);
}

// Returns the factor that keeps a tet's normalised scalars within `farthest_normalised` of 0.
inline double far_scale(double least, double largest) {
    const double most = std::max(-least, largest);
    return most > farthest_normalised ? farthest_normalised / most : 1.0;
}

// The linear pieces of a transfer function over a range, and which of them a tet's scalars meet.
class TetPieces {
  public:
    // `range`: finite, lo < hi. Neighbouring transparent pieces become one.
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
    // Returns the pieces that the tet's scalars meet; empty if one of them is not finite.
    Span met(std::span<const double> scalar, const Tet& tet) const;
    // Returns met() without the transparent pieces at both ends.
    Span visible(std::span<const double> scalar, const Tet& tet) const;
    int count(const Span& span) const;  // those that show something

  private:
    std::int32_t last() const { return static_cast<std::int32_t>(pieces_.size()) - 1; }

    std::vector<LinearPiece> pieces_;
    // Element i: number of pieces before piece i that show something. The last element counts all.
    std::vector<int> visible_before_{0};
};

}  // namespace lamina

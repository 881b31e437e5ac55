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

// Returns the range of a scalar as it is drawn, lo < hi: widened if all values are equal, and a
// little if there is a step at its end, because the later side of the step counts there.
ValueRange drawn_range(const TransferFunction& transfer_function, const ValueRange& range);

// Returns the range that exact segments normalise to [0, 1]: all values at which something visible
// changes, with a margin. Samples may lie far outside: a few odd values must not take the digits of
// the visible ones. Its width is a power of two, and its lower end is whole if the samples are:
// then they stay exact in float32, and cells whose value is a step lie on the side of that value.
ValueRange exact_range(const TransferFunction& transfer_function, const ValueRange& range,
                       SampleType type);

// Returns the range that whole tets normalise to [0, 1]: all values at which something visible
// changes, with a margin, cut to the drawn range; that range if nothing changes. `values`: at the
// mesh's points, for the window of a single step. `range`: of the finite ones.
ValueRange mesh_window(const TransferFunction& transfer_function, std::span<const double> values,
                       const ValueRange& range);

// Returns the largest component of a colour in a range.
double largest_color(const TransferFunction& transfer_function, const ValueRange& range);

// Maps a sample from `range` to [0, 1], clamped far outside; NaN if it is not finite.
float normalised_sample(double value, const ValueRange& range);

// Tets whose scalar runs far outside the window that is drawn, such as those around a value that
// marks missing data (docs/precision.md, "Exact segments").

// Distance in widths of the window: scalars of a tet that runs farther outside are computed in
// double precision at each fragment, because float32 would lose as many digits.
inline constexpr double far_for_floats = 16;

// Distance in widths of the window up to which a tet keeps its digits if it is cut at the points
// and normalised piece by piece: of a tenth of the window, float32 has 1e-4.
inline constexpr double far_for_parts = 128;

// Distance in widths of the window up to which float32 can square normalised scalars. A tet that
// runs farther outside is drawn as if the window were wider: less than 1e-18 of it lies there.
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

// The linear pieces of a transfer function over a range, as tets meet them.
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
    // Returns the pieces that the tet meets; empty if a corner's value is not finite.
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

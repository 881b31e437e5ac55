// SPDX-License-Identifier: Apache-2.0
// Tets whose scalar runs far outside the window that is drawn, such as those around a value that
// marks missing data (docs/precision.md, "Exact segments").
#pragma once

#include <algorithm>

#include "volume/min_max_bricks.h"

namespace lamina {

// Distance in widths of the window: scalars of a tet that runs farther outside are computed in
// double precision at each fragment. A scalar within the window is a difference of numbers up to
// this large, so float32 would lose as many digits.
inline constexpr double far_for_floats = 16;

// Distance in widths of the window up to which a tet keeps its digits if it is cut at the transfer
// function's points and normalised piece by piece. A piece may be a tenth of the window; float32
// then has 1e-4 of it.
inline constexpr double far_for_parts = 128;

// Distance in widths of the window up to which normalised scalars are numbers that float32 can
// square. A tet that runs farther outside is drawn as if the window were wider: in either case less
// than 1e-18 of it lies in the window, less than opaque points (optics/opacity.h) need to show.
inline constexpr double farthest_normalised = 0x1p60;

// Tells whether a range of scalars meets the window and also reaches more than `far` widths beyond
// it.
inline bool runs_beyond(const ValueRange& scalars, const ValueRange& window, double far) {
    const double most = far * (window.hi - window.lo);
    return scalars.lo < window.hi && scalars.hi > window.lo &&
           (window.lo - scalars.lo > most || scalars.hi - window.hi > most);
}

// Returns the factor on a tet's normalised scalars that keeps all within `farthest_normalised` of
// 0.
inline double far_scale(double least, double largest) {
    const double most = std::max(-least, largest);
    return most > farthest_normalised ? farthest_normalised / most : 1.0;
}

}  // namespace lamina

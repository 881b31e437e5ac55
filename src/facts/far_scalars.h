// SPDX-License-Identifier: Apache-2.0
// Tets whose scalar runs far outside the window that is drawn, as the tets around a value that
// marks missing data do (docs/precision.md, "Exact segments").
#pragma once

#include <algorithm>

#include "volume/min_max_bricks.h"

namespace lamina {

// Scalars of a tet that runs farther outside the window than this, in widths of the window, are
// computed in double precision at each fragment. A scalar within the window is then a difference of
// numbers up to this large: in float32 it would lose so many digits.
inline constexpr double far_for_floats = 16;

// Tets of a transfer function with few points are cut at these points and normalised part by part,
// which keeps digits up to so many widths: a part may be a tenth of the window, and float32 then
// has 1e-4 of it.
inline constexpr double far_for_parts = 128;

// A tet that runs farther outside is drawn as if the window were wider, so that its normalised
// scalars are numbers that float32 can square. Of such a tet less than 1e-18 lies in the window in
// either case: less than opaque points (optics/opacity.h) need to show.
inline constexpr double farthest_normalised = 0x1p60;

// Tells whether a range of scalars meets the window and also reaches more than `far` widths beyond
// it.
inline bool runs_beyond(const ValueRange& scalars, const ValueRange& window, double far) {
    const double most = far * (window.hi - window.lo);
    return scalars.lo < window.hi && scalars.hi > window.lo &&
           (window.lo - scalars.lo > most || scalars.hi - window.hi > most);
}

// The factor by which normalised scalars of a tet are scaled, so that none is farther from 0 than
// `farthest_normalised`.
inline double far_scale(double least, double largest) {
    const double most = std::max(-least, largest);
    return most > farthest_normalised ? farthest_normalised / most : 1.0;
}

}  // namespace lamina

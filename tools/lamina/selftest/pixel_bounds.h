// SPDX-License-Identifier: Apache-2.0
// Bounds on a pixel, from compositing with intervals.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina::selftest {

// A number that lies in [lo, hi].
struct Interval {
    double lo = 0, hi = 0;

    double width() const { return hi - lo; }
    void include(double value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    void include(const Interval& other) {
        lo = std::min(lo, other.lo);
        hi = std::max(hi, other.hi);
    }
    Interval widened(double by) const { return {lo - by, hi + by}; }
    Interval within(const Interval& limits) const {
        return {std::clamp(lo, limits.lo, limits.hi), std::clamp(hi, limits.lo, limits.hi)};
    }
};

// Precision of the quantities that a way to draw integrates; the self-test's bounds follow from it.
struct Precision {
    double position = 0;  // error of a point in the box, as a share of its edges
    double relative = 0;  // relative error of lengths and optical depths
    double scalar = 0;    // error of scalars, share of the volume's range
    double color = 0;     // error of a piece's colour, share of the colours that occur in it
    double face = 0;      // error of a tet's face, share of the tet's longest edge
    double slab = 0;      // error of a slab's ends, share of the depth of all slabs

    // Precision of the renderers: about 16 roundings of float32 (2^-24). Coordinates in the box are
    // relative to it at any distance of the eye, because rays are set up in double precision.
    // Faces: 9e-6 of an edge, if coefficients are relative to a pixel near the tet
    // (docs/numerics.md, section 6). Colour of a cell's fragment: 2.2e-3, from a table of 256 x 256
    // (optics/segment_integral.h).
    static constexpr Precision drawn() {
        constexpr double ulps = 1.0 / (1 << 20);
        return {ulps, ulps, ulps, 2.2e-3, 9e-6, ulps};
    }
    // Precision of the tracers: doubles, with eyes up to 1e6 box lengths away.
    static constexpr Precision traced() { return {1e-9, 1e-12, 1e-12, 1e-12, 1e-9, 0}; }
};

// A piece of a ray: possible values of its optical depth and of its colour (not associated).
struct PieceBounds {
    Interval depth;
    std::array<Interval, 3> color;
};

// Largest rounding errors of one blend (full scale is 1): of the fragment's opacity, its associated
// colour and the result. `relative`: error as a share of the opacity and of the result.
struct BlendRounding {
    double alpha = 0, color = 0, over = 0, relative = 0;

    double absolute() const { return alpha + color + over; }
};

// R, G, B, A; colour is associated.
using PixelBounds = std::array<Interval, 4>;

// Composites `pieces`, nearest first. OVER is linear in the fragment's opacity, so its extremes
// over an interval lie at the ends, and no step widens the bounds more than needed. What lies
// behind is weighted by the transmittance of what lies in front.
PixelBounds composite(const std::vector<PieceBounds>& pieces, const BlendRounding& rounding);

// Composites pieces whose intervals are single values, without rounding.
std::array<double, 4> composite_exactly(const std::vector<PieceBounds>& pieces);

// Range of a transfer function's optics over a closed interval of scalars. Both sides of a step are
// included.
struct OpticsRange {
    Interval extinction;
    std::array<Interval, 3> color;

    void include(const OpticsRange& other);
};

OpticsRange optics_range(const TransferFunction& transfer_function, const Interval& scalars);

}  // namespace lamina::selftest

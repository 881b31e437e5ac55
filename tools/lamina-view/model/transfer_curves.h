// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/color.h"
#include "lamina/transfer_function.h"

namespace lamina::view {

// A symmetric-log axis: about linear for numbers of magnitude below `linear`, and logarithmic for
// much larger ones, on both sides of 0. Places along the axis are 0 at `lo` and 1 at `hi`, and
// continue beyond.
class SymlogAxis {
  public:
    // Numbers must be finite, with lo < hi and linear > 0.
    SymlogAxis(double lo, double hi, double linear);

    double lo() const { return lo_; }
    double hi() const { return hi_; }

    // Returns the place of a number; it never falls as the number grows.
    double place(double number) const;
    // Returns the inverse: number(place(x)) differs from x by at most
    // 8 e (1 + log1p(m / linear)) (|x| + linear), where m is the largest of |x|, |lo|, |hi| and e
    // the rounding of doubles, 2^-53. It is exactly x for lo, hi and, if lo is 0, for 0.
    double number(double place) const;

    // Returns numbers to write along the axis, in order: powers of 10, and 0 if it is inside; at
    // most `most` (>= 3).
    std::vector<double> ticks(int most) const;

  private:
    double curve(double number) const;

    double lo_, hi_, linear_, from_, width_;
};

// A point at which linear pieces of the extinction curve meet.
struct ExtinctionKnot {
    double value = 0;
    double extinction = 0;  // per world unit, >= 0
    bool smooth = false;    // as in TransferKnot

    bool operator==(const ExtinctionKnot&) const = default;
};

// A point of the extinction curve, with the curve from it to the next point.
struct DensityPoint {
    double value = 0;
    double extinction = 0;  // per world unit, >= 0
    bool smooth = false;    // as in TransferKnot
    // If 0, extinction is linear up to the next point. If above 0, opacity over this many world
    // units is linear, and `inside` has the knots between the two points that approximate it.
    double opacity_length = 0;
    std::vector<ExtinctionKnot> inside;

    bool operator==(const DensityPoint&) const = default;
};

// The colour of a knot between two stops as it was read. The program that wrote it may have rounded
// otherwise than the interpolation here. It is used as long as neither stop changes.
struct KeptColor {
    ColorPoint before, after;  // the two stops
    double value = 0;
    glm::dvec3 color{0};
};

// A transfer function as it is edited, with separate curves of extinction and colour: a map of many
// colours does not add points of extinction. Both curves are linear between points and constant
// outside; two points at one value make a step.
struct TransferCurves {
    TransferCurves();  // white, and transparent everywhere

    std::vector<DensityPoint> density;  // one or more, in order of value
    std::vector<ColorPoint> colors;     // one or more, in order of value
    std::vector<KeptColor> kept;        // in order of value
    // True: the function is a palette, which steps halfway between neighbouring values of points.
    bool palette = false;

    // Returns the function of the curves. At the value of a point it has the point's own number; a
    // curve without a point there is interpolated. Throws Error if the curves are no transfer
    // function, or have too many points for a scene file.
    TransferFunction function() const;

    bool operator==(const TransferCurves& other) const;
};

// Splits a function into curves, with the points that each needs. function() of the result is the
// same function bit for bit. Successive smooth knots that follow a linear opacity become slopes,
// over `unit_length` world units if that fits.
TransferCurves curves_of(const TransferFunction& function, double unit_length);

// Returns all knots of the extinction curve, in order.
std::vector<ExtinctionKnot> knots_of(const std::vector<DensityPoint>& points);

// The limits of a curve from below and from above at a value, which differ at steps.
struct DensitySides {
    double below = 0, above = 0;
    bool smooth_below = false, smooth_above = false;  // of the knots at the value, if any
};
DensitySides density_at(const std::vector<ExtinctionKnot>& knots, double value);
struct ColorSides {
    glm::dvec3 below{0}, above{0};
};
ColorSides color_at(const std::vector<ColorPoint>& points, double value);

inline constexpr std::size_t most_points = 4096;  // that a scene file may have

// Return simple extinction curves over values from lo to hi > lo, with the maximum `densest`.
std::vector<DensityPoint> ramp_shape(double lo, double hi, double densest);
// Returns a hat a twentieth of the range wide around `at`, which is moved inside if necessary;
// 0 elsewhere.
std::vector<DensityPoint> peak_shape(double lo, double hi, double at, double densest);
// Returns 0 below a value, and `densest` from there on.
std::vector<DensityPoint> step_shape(double lo, double hi, double at, double densest);

}  // namespace lamina::view

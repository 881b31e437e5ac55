// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/color.h"
#include "lamina/transfer_function.h"

namespace lamina::view {

// A symmetric-log axis: the distance of numbers on it is their difference below `linear`, and
// follows their ratio far above it, on both sides of 0. Places along it go from 0 at `lo` to 1 at
// `hi`, and on beyond.
class SymlogAxis {
  public:
    // Finite; lo < hi, linear > 0.
    SymlogAxis(double lo, double hi, double linear);

    double lo() const { return lo_; }
    double hi() const { return hi_; }

    // Never falls as the number grows.
    double place(double number) const;
    // The inverse: number(place(x)) is x within
    // 8 e (1 + log1p(m / linear)) (|x| + linear), where m is the largest of |x|, |lo|, |hi| and e
    // the rounding of doubles, 2^-53; and exactly x for lo, hi and, where lo is 0, for 0.
    double number(double place) const;

    // Returns numbers to write along the axis: 0 if it is inside, and powers of 10; at most `most`
    // (>= 3) of them, in order.
    std::vector<double> ticks(int most) const;

  private:
    double curve(double number) const;

    double lo_, hi_, linear_, from_, width_;
};

// A point where straight pieces of the extinction curve meet.
struct ExtinctionKnot {
    double value = 0;
    double extinction = 0;  // per world unit, >= 0
    bool smooth = false;    // as in TransferKnot

    bool operator==(const ExtinctionKnot&) const = default;
};

// A point of the curve of extinction, and the way from it to the next one.
struct DensityPoint {
    double value = 0;
    double extinction = 0;
    bool smooth = false;
    // 0: extinction is linear up to the next point. Above 0: opacity over so many world units is,
    // and `inside` has the knots of the pieces that follow it.
    double opacity_length = 0;
    std::vector<ExtinctionKnot> inside;

    bool operator==(const DensityPoint&) const = default;
};

// A colour between two stops as it was read: a program may have rounded it otherwise than
// interpolation does. It counts as long as both stops are there.
struct KeptColor {
    ColorPoint before, after;
    double value = 0;
    glm::dvec3 color{0};
};

// A transfer function as it is edited: extinction and colour are curves of their own, so that a map
// of many colours leaves few points of extinction to hold. Both are linear between points and
// constant outside; two points at one value make a step.
struct TransferCurves {
    TransferCurves();  // white, and transparent everywhere

    std::vector<DensityPoint> density;  // one or more, in order of value
    std::vector<ColorPoint> colors;     // the same
    std::vector<KeptColor> kept;        // in order of value
    // The function steps halfway between neighbouring values of both curves (a palette).
    bool palette = false;

    // Returns the function of the curves. It has the points' own numbers, and interpolated ones at
    // values at which only one curve has a point. Throws Error if the curves are no transfer
    // function, or one with too many points for a scene file.
    TransferFunction function() const;

    bool operator==(const TransferCurves& other) const;
};

// Splits a function into curves: function() gives back the same, bit for bit. Each curve gets only
// the points that it needs. Successive smooth points that follow an opacity become slopes, over
// `unit_length` world units if that fits.
TransferCurves curves_of(const TransferFunction& function, double unit_length);

// All knots of the curve of extinction, in order.
std::vector<ExtinctionKnot> knots_of(const std::vector<DensityPoint>& points);

// Limits of a curve from below and from above at a value: they differ at steps.
struct DensitySides {
    double below = 0, above = 0;
    bool smooth_below = false, smooth_above = false;  // of knots at the value
};
DensitySides density_at(const std::vector<ExtinctionKnot>& knots, double value);
struct ColorSides {
    glm::dvec3 below{0}, above{0};
};
ColorSides color_at(const std::vector<ColorPoint>& points, double value);

inline constexpr std::size_t most_points = 4096;  // of a scene file

// Simple curves of extinction over values from lo to hi > lo, up to `densest`.
std::vector<DensityPoint> ramp_shape(double lo, double hi, double densest);
// A hat a twentieth of the range wide, around a value that is kept inside, and 0 elsewhere.
std::vector<DensityPoint> peak_shape(double lo, double hi, double at, double densest);
// 0 up to a value, `densest` from there on.
std::vector<DensityPoint> step_shape(double lo, double hi, double at, double densest);

}  // namespace lamina::view

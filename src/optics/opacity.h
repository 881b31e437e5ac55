// SPDX-License-Identifier: Apache-2.0
// Converts between opacity, extinction and optical depth (LaMar 2004, equations 1 and 2;
// docs/numerics.md, section 1), and between points with opacity and points with extinction.
#pragma once

#include <cmath>
#include <cstddef>

#include "lamina/transfer_function.h"

namespace lamina {

// Optical depth over unit_length that stands for opacity 1, which has no finite extinction.
inline constexpr double opaque_optical_depth = 1e7;

inline double opacity_from_depth(double optical_depth) {
    return -std::expm1(-optical_depth);
}

// Returns the extinction per world unit with `opacity` (0..1) over `unit_length` > 0 world units.
inline double extinction_from_opacity(double opacity, double unit_length) {
    return (opacity < 1 ? -std::log1p(-opacity) : opaque_optical_depth) / unit_length;
}

// Largest optical depth (over unit_length) at ends of slopes of opacity: opacity >= 1 - 4e-8 there.
inline constexpr double steepest_optical_depth = 17;

// Largest distance of straight pieces from the extinction's curve, as a share of its value. Changes
// colours in 0..1 by at most half: .1 / 255 (docs/precision.md, "Opacity that is linear").
inline constexpr double opacity_slope_tolerance = 7.8e-4;

struct OpacitySlopeKnot {
    double share = 0;          // position on the slope, inside (0, 1): 0 at `from`, 1 at `to`
    double optical_depth = 0;  // over unit_length
};

// Approximates the optical depth -log1p(-opacity), with opacity linear from `from` to `to` (in
// 0..1), by the fewest pieces within opacity_slope_tolerance. Returns the inner knots in order.
std::vector<OpacitySlopeKnot> follow_opacity(double from, double to);

struct GivenPoint {
    enum class Density { extinction, opacity };

    double value = 0;
    glm::dvec3 color{0};
    Density given_as = Density::extinction;
    double density = 0;   // extinction per world unit, or opacity (0..1) over a unit length
    bool smooth = false;  // TransferKnot::smooth, for points given by extinction
};

// Converts each point's opacity to extinction. Between points extinction is linear, not opacity.
std::vector<TransferKnot> linear_in_extinction(const std::vector<GivenPoint>& points,
                                               double unit_length);

// Converts points so that opacity is linear between two points that are given by it, and extinction
// between others. The points must pass TransferFunction::linear() after linear_in_extinction().
// Throws Error if slopes add more than most_scene_points knots.
std::vector<TransferKnot> linear_in_opacity(const std::vector<GivenPoint>& points,
                                            double unit_length);

// Largest number of points of a colour map, and of knots that slopes of opacity add.
inline constexpr std::size_t most_scene_points = 4096;
// Largest number of points that a scene gives: a palette of 65,535 labels has two for each.
inline constexpr std::size_t most_given_points = std::size_t{1} << 17;

}  // namespace lamina

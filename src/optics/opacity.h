// SPDX-License-Identifier: Apache-2.0
// Opacity, extinction, depth (LaMar 2004, equations 1 and 2; docs/numerics.md, section 1).
#pragma once

#include <cmath>
#include <cstddef>

#include "lamina/transfer_function.h"

namespace lamina {

// Opacity 1 has no finite extinction. This optical depth over unit_length stands for it.
inline constexpr double opaque_optical_depth = 1e7;

inline double opacity_from_depth(double optical_depth) {
    return -std::expm1(-optical_depth);
}

// `opacity` in [0, 1] over `unit_length` > 0 world units.
inline double extinction_from_opacity(double opacity, double unit_length) {
    return (opacity < 1 ? -std::log1p(-opacity) : opaque_optical_depth) / unit_length;
}

// Limit of the optical depth next to a slope of opacity, which is at least 1 - 4e-8 from there on.
inline constexpr double steepest_optical_depth = 17;

// Largest distance of the pieces from the curve, relative to its value: changes a ray's colours, of
// points in 0..1, by at most half of it: .1 / 255 (docs/precision.md, "Opacity that is linear").
inline constexpr double opacity_slope_tolerance = 7.8e-4;

struct OpacitySlopeKnot {
    double share = 0;          // of the way from one end of the slope to the other, inside (0, 1)
    double optical_depth = 0;  // over unit_length
};

// Approximates -log1p(-opacity) by the fewest straight pieces that keep to the tolerance while
// opacity goes linearly between two values in 0..1. Returns the knots between the ends, in order.
std::vector<OpacitySlopeKnot> follow_opacity(double from, double to);

// A point of a transfer function as a user gives it.
struct GivenPoint {
    enum class Density { extinction, opacity };

    double value = 0;
    glm::dvec3 color{0};
    Density given_as = Density::extinction;
    double density = 0;   // per world unit, or 0..1 over a unit length
    bool smooth = false;  // as in TransferKnot; of extinction
};

// Converts opacities to extinctions, one by one; extinction is linear between them.
std::vector<TransferKnot> linear_in_extinction(const std::vector<GivenPoint>& points,
                                               double unit_length);

// Opacity is linear between two points that are given by it, extinction between others. The points
// must pass TransferFunction::linear() after linear_in_extinction(). Throws Error for more knots
// than a scene file may have points.
std::vector<TransferKnot> linear_in_opacity(const std::vector<GivenPoint>& points,
                                            double unit_length);

inline constexpr std::size_t most_scene_points = 4096;

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina {

// A point of a transfer function as a user gives it.
struct GivenPoint {
    enum class Density { extinction, opacity };

    double value = 0;
    glm::dvec3 color{0};
    Density given_as = Density::extinction;
    double density = 0;   // per world unit, or 0..1 over a unit length
    bool smooth = false;  // as in TransferKnot; of extinction
};

// The points with opacity turned into extinction, one by one: extinction is linear between them.
// Opacity 1 becomes opaque_optical_depth over unit_length (optics/opacity.h).
std::vector<TransferKnot> linear_in_extinction(const std::vector<GivenPoint>& points,
                                               double unit_length);

// The knots of a function whose opacity is linear between two points that are given by opacity
// (optics/opacity_slope.h says how far off they are), and whose extinction is linear between
// others. Where opacity is 1 over an interval, or beyond the first or last point, the optical depth
// over unit_length is opaque_optical_depth; beside a slope it is at most steepest_optical_depth.
// The points must pass TransferFunction::linear() as linear_in_extinction() has them. Throws Error
// where there are more knots than a scene file may have points.
std::vector<TransferKnot> linear_in_opacity(const std::vector<GivenPoint>& points,
                                            double unit_length);

inline constexpr std::size_t most_scene_points = 4096;

}  // namespace lamina

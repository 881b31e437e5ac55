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

// Converts the points' opacities to extinctions, one by one; extinction is linear between them.
// Opacity 1 becomes opaque_optical_depth over unit_length (optics/opacity.h).
std::vector<TransferKnot> linear_in_extinction(const std::vector<GivenPoint>& points,
                                               double unit_length);

// Returns the knots of a function whose opacity is linear between two points that are given by
// opacity (error: optics/opacity_slope.h), and whose extinction is linear between others. If
// opacity is 1 over an interval, or beyond the first or last point, the optical depth over
// unit_length is opaque_optical_depth; next to a slope it is at most steepest_optical_depth. The
// points must pass TransferFunction::linear() after linear_in_extinction(). Throws Error if there
// are more knots than a scene file may have points.
std::vector<TransferKnot> linear_in_opacity(const std::vector<GivenPoint>& points,
                                            double unit_length);

inline constexpr std::size_t most_scene_points = 4096;

}  // namespace lamina

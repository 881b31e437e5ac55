// SPDX-License-Identifier: Apache-2.0
// Shapes as signed distances, negative inside (Quilez, "Distance functions", iquilezles.org), for
// generated data. They use only operations that IEEE 754 rounds alike on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace lamina {

// Approximate, exact at the surface.
inline double distance_to_ellipsoid(const glm::dvec3& p, const glm::dvec3& center,
                                    const glm::dvec3& radii) {
    const glm::dvec3 scaled = (p - center) / radii;
    const double slope = glm::length(scaled / radii);
    const double length = glm::length(scaled);
    if (slope == 0) return -std::min({radii.x, radii.y, radii.z});
    return length * (length - 1) / slope;
}

// A rod with round ends, whose radius changes evenly from one end to the other.
inline double distance_to_rod(const glm::dvec3& p, const glm::dvec3& begin, const glm::dvec3& end,
                              double begin_radius, double end_radius) {
    const glm::dvec3 along = end - begin;
    const double t = std::clamp(glm::dot(p - begin, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(p - begin - t * along) - (begin_radius + t * (end_radius - begin_radius));
}

// A box around the origin with edges rounded by `radius`, which `half` includes.
inline double distance_to_box(const glm::dvec3& p, const glm::dvec3& half, double radius) {
    const glm::dvec3 beyond = glm::abs(p) - half + radius;
    return glm::length(glm::max(beyond, glm::dvec3(0))) +
           std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0) - radius;
}

// Union of two shapes with a fillet of about the size `blend`.
inline double smooth_union(double a, double b, double blend) {
    const double near = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - near * near * blend / 4;
}

// Takes shape `b` away from `a` and rounds the edge.
inline double smooth_difference(double a, double b, double blend) {
    return -smooth_union(-a, b, blend);
}

}  // namespace lamina

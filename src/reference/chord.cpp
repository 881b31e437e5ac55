// SPDX-License-Identifier: Apache-2.0
#include "reference/chord.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "reference/clip_span.h"

namespace lamina {
namespace {

// One coordinate of a ray in index space: position + z * slope.
struct Coordinate {
    DoubleDouble position;
    DoubleDouble slope;
};

// Projects on one (orthogonal) grid axis.
LAMINA_IN_CLONES Coordinate project(const DoubleDouble (&offset)[3],
                                    const DoubleDouble (&direction)[3],
                                    const GridAxes::Axis& axis) {
    const DoubleDouble unscale{axis.unscale, 0};
    return {dot(offset, axis.scaled) * axis.inverse_square * unscale,
            dot(direction, axis.scaled) * axis.inverse_square * unscale};
}

// Where a coordinate meets two planes.
struct PlanePair {
    DoubleDouble first, second;
};
LAMINA_IN_CLONES PlanePair meet(const Coordinate& ray, double first, double second) {
    const DoubleDouble to_first = DoubleDouble{first, 0} - ray.position;
    const DoubleDouble to_second = DoubleDouble{second, 0} - ray.position;
    const DoubleDouble inverse = DoubleDouble{1, 0} / ray.slope;
    // A subnormal inverse has lost its low part.
    if (!inverse.finite() || std::abs(inverse.hi) < 1e-290)
        return {to_first / ray.slope, to_second / ray.slope};
    return {to_first * inverse, to_second * inverse};
}

// Returns the part of z >= 0 where every coordinate is inside its closed range. Where there is
// none, from >= to.
LAMINA_IN_CLONES RaySpan clip_to_faces(const Coordinate (&ray)[3], const glm::dvec3& lowest,
                                       const glm::dvec3& highest, int& entry_axis) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    RaySpan inside{{0, 0}, {infinity, 0}};
    for (int axis = 0; axis < 3; ++axis) {
        if (ray[axis].slope.hi == 0) {
            const DoubleDouble p = ray[axis].position;
            if (p < DoubleDouble{lowest[axis], 0} || DoubleDouble{highest[axis], 0} < p) return {};
            continue;
        }
        auto [near, far] = meet(ray[axis], lowest[axis], highest[axis]);
        if (far < near) std::swap(near, far);
        if (inside.from < near) {
            inside.from = near;
            entry_axis = axis;
        }
        if (far < inside.to) inside.to = far;
    }
    return inside;
}

}  // namespace

Chord clip_to_box(const Grid& grid, const View::Ray& ray, std::span<const HalfSpace> clip) {
    return clip_to_box(GridAxes(grid), ray, clip);
}

LAMINA_CLONE_FOR_FMA
Chord clip_to_box(const GridAxes& grid, const View::Ray& ray, std::span<const HalfSpace> clip) {
    DoubleDouble offset[3], direction[3];
    for (int i = 0; i < 3; ++i) {
        offset[i] = exact_sum(ray.origin[i], -grid.origin[i]);
        direction[i] = {ray.direction[i], 0};
    }
    Coordinate coordinates[3];
    double steepest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        coordinates[axis] = project(offset, direction, grid.axes[static_cast<std::size_t>(axis)]);
        if (!coordinates[axis].position.finite() || !coordinates[axis].slope.finite()) return {};
        steepest = std::max(steepest, std::abs(coordinates[axis].slope.hi));
    }
    // A slope that moves the ray by less than 1e-30 voxels while it crosses the box has no effect
    // but a risk of overflow.
    for (Coordinate& coordinate : coordinates) {
        if (std::abs(coordinate.slope.hi) < 1e-40 * steepest) coordinate.slope = {};
    }
    const glm::dvec3 &lowest = grid.lowest, &highest = grid.highest;
    int entry_axis = -1;
    RaySpan inside = clip_to_faces(coordinates, lowest, highest, entry_axis);
    if (!(inside.from < inside.to)) return {};
    const DoubleDouble of_box = inside.from;
    clip_span(clip, ray, inside);
    if (!(inside.from < inside.to)) return {};
    if (of_box < inside.from) entry_axis = -1;

    Chord chord;
    chord.length_z = (inside.to - inside.from).rounded();
    chord.world_per_z = glm::length(ray.direction);
    for (int axis = 0; axis < 3; ++axis) {
        const auto& [position, slope] = coordinates[axis];
        chord.direction[axis] = slope.rounded();
        chord.entry[axis] =
            std::clamp((position + slope * inside.from).rounded(), lowest[axis], highest[axis]);
    }
    if (entry_axis >= 0) {
        chord.entry[entry_axis] =
            chord.direction[entry_axis] > 0 ? lowest[entry_axis] : highest[entry_axis];
    }
    return chord;
}

double chord_length(const Grid& grid, const View& view, double column, double row) {
    return clip_to_box(grid, view.ray(column, row)).world_length();
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace lamina {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Returns the depth at which a point that moves along an axis leaves the interval between two
// places.
double depth_of_exit(double place, double change, double min, double max) {
    if (change > 0) return (max - place) / change;
    return change < 0 ? (min - place) / change : never;
}

// Returns the number of slabs before `end` that lie wholly in front of a depth.
int slabs_before(double depth, double thickness, int first, int end) {
    return static_cast<int>(std::clamp(std::floor(depth / thickness), static_cast<double>(first),
                                       static_cast<double>(end)));
}

}  // namespace

// Points of one depth are linear in column and row: all lie within the reach of the corners. From
// pixel to pixel either origins and directions change by constant steps, or directions not at all:
// so reach is linear, too.
TileBounds::TileBounds(const TileRays& rays, const TileBrickView& brick, int column, int row,
                       int edge) {
    const double half = 0.5 * (edge - 1);
    const double x = column + 0.5 + half - rays.middle_column;
    const double y = row + 0.5 + half - rays.middle_row;
    middle_ = brick.origin_middle + brick.first + x * rays.origin_column + y * rays.origin_row;
    middle_change_ = rays.direction_middle + x * rays.direction_column + y * rays.direction_row;
    reach_ = half * (glm::abs(rays.origin_column) + glm::abs(rays.origin_row)) + brick.margin;
    reach_change_ = half * (glm::abs(rays.direction_column) + glm::abs(rays.direction_row));
}

// Along a ray points are linear in depth: all lie between those at the front and at the back.
bool TileBounds::shows(const OccupiedBricks& bricks, const TileRays& rays, int first,
                       int end) const {
    const double front = first * rays.slab_thickness;
    const double back = end * rays.slab_thickness;
    const glm::dvec3 near = middle_at(front), far = middle_at(back);
    const glm::dvec3 reach = reach_ + back * reach_change_;
    return bricks.any_in(glm::min(near, far) - reach, glm::max(near, far) + reach);
}

TileBounds::Stretch TileBounds::next_stretch(const OccupiedBricks& bricks, const TileRays& rays,
                                             int first, int end) const {
    const double thickness = rays.slab_thickness;
    const double front = first * thickness;
    const glm::dvec3 middle = middle_at(front);
    const glm::dvec3 reach = reach_ + front * reach_change_;
    glm::dvec3 min, max;
    const bool empty = bricks.empty_around(middle, min, max);
    double exit = never;
    if (!empty) {
        for (int axis = 0; axis < 3; ++axis)
            exit = std::min(
                exit, depth_of_exit(middle_[axis], middle_change_[axis], min[axis], max[axis]));
        return {slabs_before(exit, thickness, first + 1, end), true};
    }
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
        inside = inside && middle[axis] - reach[axis] >= min[axis] &&
                 middle[axis] + reach[axis] <= max[axis];
        exit = std::min(
            {exit,
             depth_of_exit(middle_[axis] - reach_[axis], middle_change_[axis] - reach_change_[axis],
                           min[axis], never),
             depth_of_exit(middle_[axis] + reach_[axis], middle_change_[axis] + reach_change_[axis],
                           -never, max[axis])});
    }
    const int empty_end = inside ? slabs_before(exit, thickness, first, end) : first;
    if (empty_end > first) return {empty_end, false};
    const int tested_end = std::min(first + rays.tested_slabs, end);
    return {tested_end, shows(bricks, rays, first, tested_end)};
}

}  // namespace lamina

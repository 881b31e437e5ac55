// SPDX-License-Identifier: Apache-2.0
#include "slicing/cpu_slabs.h"

#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "base/parallel.h"

namespace lamina {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Returns the depth at which a point at `place` + depth * `change` on an axis leaves min .. max.
double depth_of_exit(double place, double change, double min, double max) {
    if (change > 0) return (max - place) / change;
    return change < 0 ? (min - place) / change : never;
}

// Returns the number of slabs that lie wholly in front of a depth, limited to first .. end.
int slabs_before(double depth, double thickness, int first, int end) {
    return static_cast<int>(std::clamp(std::floor(depth / thickness), static_cast<double>(first),
                                       static_cast<double>(end)));
}

}  // namespace

CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied) {
    CellMap map;
    if (varied == nullptr) {
        if (occupied != nullptr) map = {occupied->count, occupied->distance};
        return map;
    }
    map.count = varied->count;
    const std::size_t bricks = varied->distance.size(), together = 1 << 16;
    map.kinds = SparseBytes(bricks, occupied != nullptr ? CellMap::farthest : 0);
    parallel_for(
        static_cast<std::int64_t>((bricks + together - 1) / together), 1, [&](std::int64_t part) {
            const std::size_t first = static_cast<std::size_t>(part) * together;
            std::vector<std::uint8_t> kinds(std::min(together, bricks - first));
            for (std::size_t i = 0; i < kinds.size(); ++i) {
                const int empty = occupied != nullptr ? occupied->distance[first + i] : 0;
                const int constant = varied->distance[first + i];
                kinds[i] = static_cast<std::uint8_t>(empty > 0      ? empty
                                                     : constant > 0 ? CellMap::constant + constant
                                                                    : 0);
            }
            map.kinds.set(first, kinds);
        });
    return map;
}

// At one depth points are linear in column and row, so all lie within the distance of the corners
// from the middle ray. From pixel to pixel origins change by a constant step, and so do directions
// unless rays are parallel; so this distance is linear in depth.
CpuBounds::CpuBounds(const CpuRays& rays, const CpuBrickView& brick, int column, int row,
                     int edge) {
    const double half = 0.5 * (edge - 1);
    const double x = column + 0.5 + half - rays.middle_column;
    const double y = row + 0.5 + half - rays.middle_row;
    middle_ = brick.origin_middle + brick.first + x * rays.origin_column + y * rays.origin_row;
    middle_change_ = rays.direction_middle + x * rays.direction_column + y * rays.direction_row;
    reach_ = half * (glm::abs(rays.origin_column) + glm::abs(rays.origin_row)) + brick.margin;
    reach_change_ = half * (glm::abs(rays.direction_column) + glm::abs(rays.direction_row));
}

// Points of a ray are linear in depth: all lie in the box around the ends at front and back.
bool CpuBounds::shows(const OccupiedBricks& bricks, const CpuRays& rays, int first, int end) const {
    const double front = first * rays.slab_thickness;
    const double back = end * rays.slab_thickness;
    const glm::dvec3 near = middle_at(front), far = middle_at(back);
    const glm::dvec3 reach = reach_ + back * reach_change_;
    return bricks.any_in(glm::min(near, far) - reach, glm::max(near, far) + reach);
}

// Decides slabs by the bricks around the middle ray at the front of slab `first`:
//   in a visible brick: slabs are shown up to where the middle ray leaves the brick;
//   in an empty box that holds all rays: slabs are hidden up to where the first ray leaves the box;
//   otherwise: `tested_slabs` slabs are shown if the box around their rays meets a visible brick.
CpuBounds::SlabRange CpuBounds::next_range(const OccupiedBricks& bricks, const CpuRays& rays,
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

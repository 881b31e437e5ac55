// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_bounds.h"

#include <algorithm>
#include <glm/common.hpp>

namespace lamina {

TileBounds::TileBounds(const TileRays& rays, const TileBrickView& brick, int column, int row,
                       int edge)
    : margin_(brick.margin) {
    const double left = column + 0.5 - rays.middle_column, top = row + 0.5 - rays.middle_row;
    const glm::dvec3 middle = brick.origin_middle + brick.first;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const double x = left + ((corner & 1) != 0 ? edge - 1 : 0);
        const double y = top + ((corner & 2) != 0 ? edge - 1 : 0);
        const glm::dvec3 origin = middle + x * rays.origin_column + y * rays.origin_row;
        const glm::dvec3 direction =
            rays.direction_middle + x * rays.direction_column + y * rays.direction_row;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis][corner] = origin[static_cast<int>(axis)];
            direction_[axis][corner] = direction[static_cast<int>(axis)];
        }
    }
}

TileBounds::Box TileBounds::box_at(double depth) const {
    Box box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<double, 4> place{};
        for (std::size_t corner = 0; corner < 4; ++corner)
            place[corner] = origin_[axis][corner] + depth * direction_[axis][corner];
        const auto [least, most] = std::ranges::minmax(place);
        box.min[static_cast<int>(axis)] = least;
        box.max[static_cast<int>(axis)] = most;
    }
    return box;
}

// Along a ray points are linear in depth: all lie between those at the front and at the back.
bool TileBounds::shows(const TileSlabs& slabs, int first, int end) const {
    const Box front = box_at(first * slabs.rays.slab_thickness);
    const Box back = box_at(end * slabs.rays.slab_thickness);
    return slabs.occupied->any_in(glm::min(front.min, back.min) - margin_,
                                  glm::max(front.max, back.max) + margin_);
}

SampleSpan TileBounds::shown(const TileSlabs& slabs, int first, int end) const {
    const int step = slabs.rays.tested_slabs;
    while (first < end && !shows(slabs, first, std::min(first + step, end)))
        first = std::min(first + step, end);
    while (end - first > step && !shows(slabs, end - step, end)) end -= step;
    return {first, end - first};
}

}  // namespace lamina

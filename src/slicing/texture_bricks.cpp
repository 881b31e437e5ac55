// SPDX-License-Identifier: Apache-2.0
#include "slicing/texture_bricks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamina {

IndexBox box_of(const TextureBrick& brick, const Grid& grid) {
    IndexBox box{grid.index_min(), grid.index_max()};
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t first = brick.first[axis], last = first + brick.size[axis] - 1;
        if (brick.bordered) {
            box.min[axis] = std::max(box.min[axis], static_cast<double>(first));
            box.max[axis] = std::min(box.max[axis], static_cast<double>(last));
            continue;
        }
        if (first > 0) box.min[axis] = static_cast<double>(first);
        if (last < grid.size[axis] - 1) box.max[axis] = static_cast<double>(last);
    }
    return box;
}

glm::dvec3 last_face_of(const glm::dvec3& end, const glm::dvec3& first, const Grid& grid) {
    const glm::dvec3 border(
        glm::vec3(grid.index_max() - first));  // boxes are rounded to float, too
    glm::dvec3 face = no_last_face;
    for (int axis = 0; axis < 3; ++axis) {
        if (end[axis] >= border[axis]) face[axis] = border[axis];
    }
    return face;
}

BrickRow row_of(const TextureBrick& brick, const Grid& grid, std::int64_t y, std::int64_t z) {
    const auto own = [&](std::size_t axis, std::int64_t place) {
        return std::clamp<std::int64_t>(brick.first[axis] + place, 0, grid.size[axis] - 1);
    };
    const std::int64_t begin = std::max<std::int64_t>(-brick.first[0], 0);
    const std::int64_t end = std::min(brick.size[0], grid.size[0] - brick.first[0]);
    const std::int64_t first = (own(2, z) * grid.size[1] + own(1, y)) * grid.size[0] + own(0, 0);
    return {static_cast<std::size_t>(first), begin, end};
}

void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers) {
    const auto& first = bricks.front().first;  // of all
    const glm::dvec3 eye = grid.to_index(view.eye) - glm::dvec3(first[0], first[1], first[2]);
    const glm::dvec3 forward = grid.direction_to_index(view.forward);
    // Along a ray no brick number ever goes back towards the eye's own on any axis, and each step
    // into another brick changes one of them: so the sum over the axes of the distances in bricks
    // orders them. For parallel rays the distance along an axis counts in the direction of the
    // view.
    const auto distance_of = [&](std::size_t i) {
        double distance = 0;
        for (int axis = 0; axis < 3; ++axis) {
            // The first brick has the full size; all begin at multiples of its cells.
            const double cells =
                std::max<double>(1, static_cast<double>(bricks.front().size[axis] - 1));
            const double number = static_cast<double>(bricks[i].first[axis] - first[axis]) / cells;
            if (view.projection == Projection::perspective) {
                distance += std::abs(number - std::floor(eye[axis] / cells));
            } else {
                distance += forward[axis] >= 0 ? number : -number;
            }
        }
        return order == Order::front_to_back ? distance : -distance;
    };
    numbers.resize(bricks.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    // std::stable_sort would take memory.
    std::sort(numbers.begin(), numbers.end(), [&](std::size_t a, std::size_t b) {
        const double one = distance_of(a), other = distance_of(b);
        return one < other || (one == other && a < b);
    });
}

}  // namespace lamina

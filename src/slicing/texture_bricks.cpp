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
        if (first > 0) box.min[axis] = static_cast<double>(first);
        if (last < grid.size[axis] - 1) box.max[axis] = static_cast<double>(last);
    }
    return box;
}

// Along a ray no brick number ever goes back towards the eye's own on any axis, and each step into
// another brick changes one of them: so the sum over the axes of the distances in bricks orders
// them. For parallel rays the distance along an axis counts in the direction of the view.
std::vector<std::size_t> visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                                          const View& view, Order order) {
    const glm::dvec3 eye = grid.to_index(view.eye);
    const glm::dvec3 forward = grid.direction_to_index(view.forward);
    std::vector<double> distance(bricks.size());
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            // The first brick has the full size; all begin at multiples of its cells.
            const double cells =
                std::max<double>(1, static_cast<double>(bricks.front().size[axis] - 1));
            const double number = static_cast<double>(bricks[i].first[axis]) / cells;
            if (view.projection == Projection::perspective) {
                distance[i] += std::abs(number - std::floor(eye[axis] / cells));
            } else {
                distance[i] += forward[axis] >= 0 ? number : -number;
            }
        }
    }
    std::vector<std::size_t> sorted(bricks.size());
    std::iota(sorted.begin(), sorted.end(), std::size_t{0});
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
        return order == Order::front_to_back ? distance[a] < distance[b]
                                             : distance[a] > distance[b];
    });
    return sorted;
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "plan/volume_shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace lamina {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

// Boxes of this many cells or more are cut between bricks: their ranges say no more.
constexpr double cells_to_cut_finely = 16 * MinMaxBricks::edge;

// Where nothing shows, halves of the box are equal parts.
constexpr double cost_of_emptiness = 1e-6;

// The number of boxes with smaller coordinates than the cut that divides `count` boxes.
int below_of(int count) {
    return count / 2;
}

}  // namespace

VolumeShares::VolumeShares(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks,
                           bool in_files, int count) {
    const auto& size = facts.grid.size;
    const glm::dvec3 last(size[0] - 1, size[1] - 1, size[2] - 1);
    divide(ShareCosts(scene, facts, bricks, in_files), {glm::dvec3(-endless), glm::dvec3(endless)},
           {glm::dvec3(0), last}, count);
}

void VolumeShares::divide(const ShareCosts& costs, const IndexBox& box, const IndexBox& between,
                          int count) {
    if (count == 1) {
        boxes_.push_back(box);
        return;
    }
    Cut cut = best_cut(costs, between, count);
    cut.place = std::min(cut.place, box.max[cut.axis]);
    cuts_.push_back(cut);
    IndexBox below = box, above = box, between_below = between, between_above = between;
    below.max[cut.axis] = above.min[cut.axis] = cut.place;
    between_below.max[cut.axis] = between_above.min[cut.axis] = cut.place;
    divide(costs.part(cut.axis, cut.place, false), below, between_below, below_of(count));
    divide(costs.part(cut.axis, cut.place, true), above, between_above, count - below_of(count));
}

// On each axis the plane is found that divides the cost as the boxes are divided. Of these three
// the one is taken with the least cost for a renderer: a part behind another one draws much that
// the other hides.
VolumeShares::Cut VolumeShares::best_cut(const ShareCosts& costs, const IndexBox& between,
                                         int count) {
    const double below = below_of(count), above = count - below_of(count);
    const glm::dvec3 size = between.max - between.min;
    std::array<int, 3> axes{0, 1, 2};
    std::ranges::stable_sort(axes, std::greater(), [&](int axis) { return size[axis]; });
    // Where nothing can be cut, all is below.
    Cut best{axes[0], between.max[axes[0]] + 1};
    double least = endless;
    for (const int axis : axes) {
        const double unit = size[axis] >= cells_to_cut_finely ? double{MinMaxBricks::edge} : 1.0;
        auto low = static_cast<std::int64_t>(std::floor(between.min[axis] / unit)) + 1;
        auto high = static_cast<std::int64_t>(std::ceil(between.max[axis] / unit)) - 1;
        if (low > high) continue;
        const auto costs_at = [&](std::int64_t number) {
            const double place = static_cast<double>(number) * unit;
            ShareCosts::Pair pair = costs.of_parts(axis, place);
            const double share = (place - between.min[axis]) / size[axis];
            return ShareCosts::Pair{(pair.below + cost_of_emptiness * share) / below,
                                    (pair.above + cost_of_emptiness * (1 - share)) / above};
        };
        const auto try_place = [&](std::int64_t number) {
            const auto [one, other] = costs_at(number);
            if (std::max(one, other) < least) {
                least = std::max(one, other);
                best = {axis, static_cast<double>(number) * unit};
            }
            return one < other;
        };
        while (low <= high) {
            const std::int64_t middle = low + (high - low) / 2;
            if (try_place(middle)) {
                low = middle + 1;
            } else {
                high = middle - 1;
            }
        }
    }
    return best;
}

std::vector<int> VolumeShares::front_to_back(const Grid& grid, const View& view) const {
    const glm::dvec3 eye = grid.to_index(view.eye);
    const glm::dvec3 forward = grid.direction_to_index(view.forward);
    std::vector<int> order;
    const std::function<void(std::size_t, int, int)> visit = [&](std::size_t number, int first,
                                                                 int count) {
        if (count == 1) {
            order.push_back(first);
            return;
        }
        const Cut& cut = cuts_[number];
        const bool below_first = view.projection == Projection::perspective
                                     ? eye[cut.axis] < cut.place
                                     : forward[cut.axis] >= 0;
        const int below = below_of(count);
        const auto visit_below = [&] { visit(number + 1, first, below); };
        const auto visit_above = [&] {
            visit(number + static_cast<std::size_t>(below), first + below, count - below);
        };
        if (below_first) visit_below();
        visit_above();
        if (!below_first) visit_below();
    };
    visit(0, 0, static_cast<int>(boxes_.size()));
    return order;
}

}  // namespace lamina

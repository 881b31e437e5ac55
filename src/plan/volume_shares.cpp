// SPDX-License-Identifier: Apache-2.0
#include "plan/volume_shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <limits>

#include "base/parallel.h"
#include "facts/volume_facts.h"
#include "volume/brick_cache.h"

namespace lamina {
namespace {

// Number of rays along a picture's side, and of steps along a ray, to estimate costs on.
constexpr int rays_along_side = 48, most_steps = 192;

// Cost, in cells that rays walk through, of a ray in each box in which it meets something visible:
// the box's renderer sets up the ray, and its pixel is composited once more.
constexpr double cells_of_ray = 8;

// Cost, in cells that rays walk through, of reading a brick of the cache: measured 130 us from a
// file that the system has in memory, against 68 ns for a cell.
constexpr double cells_of_page = 1900;

int columns_of(const View& view) {
    return std::min(rays_along_side, view.width);
}
int rows_of(const View& view) {
    return std::min(rays_along_side, view.height);
}

bool in_picture(const View& view, const glm::dvec3& point) {
    const glm::dvec3 from_eye = point - view.eye;
    const double depth = glm::dot(from_eye, view.forward);
    const double half = 0.5 * view.pixel * (view.projection == Projection::perspective ? depth : 1);
    return depth > 0 && std::abs(glm::dot(from_eye, view.right)) < half * view.width &&
           std::abs(glm::dot(from_eye, view.up)) < half * view.height;
}

// Returns the mean extinction of a brick as if all values of its range were equally frequent.
double mean_extinction(const TransferFunction& transfer_function, const ValueRange& range) {
    constexpr int places = 4;
    double sum = 0;
    for (int i = 0; i < places; ++i)
        sum +=
            transfer_function.at(range.lo + (i + 0.5) / places * (range.hi - range.lo)).extinction;
    return sum / places;
}

bool cut_away(const Facts& facts, const glm::dvec3& at) {
    return std::ranges::any_of(facts.clip,
                               [&](const IndexPlane& plane) { return plane.distance(at) < 0; });
}

// Place of a box's side that is not cut.
constexpr double endless = std::numeric_limits<double>::infinity();

// Number of cells along a side from which on boxes are cut only between bricks, because the ranges
// of bricks tell nothing about smaller pieces.
constexpr double cells_to_cut_finely = 16 * MinMaxBricks::edge;

// Cost of a box in which nothing shows, in cells: above 0, so that it, too, is cut into halves.
constexpr double cost_of_emptiness = 1e-6;

// Returns the number of boxes on the lower side of the cut that divides `count` boxes.
int below_of(int count) {
    return count / 2;
}

}  // namespace

// Costs of drawing a box of a volume, in cells that rays walk through, estimated on rays all over
// the view from the ranges of bricks. A ray ends in a box once the box alone is opaque on it.
struct ShareCosts {
    // Costs of the two boxes below and above a plane across an axis.
    struct Pair {
        double below = 0, above = 0;
    };
    Pair of_sides(int axis, double place) const;

    // Returns the costs inside one of these two boxes.
    ShareCosts side(int axis, double place, bool above) const;

    // A step along a ray in a visible brick.
    struct RayStep {
        glm::vec3 middle;     // in index space
        float cells;          // that the ray walks through in it
        float optical_depth;  // estimated
        std::int32_t ray;
    };

    std::vector<RayStep> ray_steps;  // ray by ray, front to back
    std::vector<glm::vec3> pages;    // middles of the cache's bricks that are read, in index space
    // Optical depth at which rays end; cost of reading one of `pages`, scaled to the tried rays.
    double opaque_depth = 0, page_cost = 0;
};

namespace {

std::vector<ShareCosts::RayStep> find_ray_steps(const Scene& scene, const Facts& facts,
                                                const MinMaxBricks& bricks) {
    const View view(*scene.camera, scene.width, scene.height);
    const int columns = columns_of(view), rows = rows_of(view);
    const int steps = static_cast<int>(
        std::clamp(facts.voxels_along_view / MinMaxBricks::edge, 8.0, double{most_steps}));
    const double step = (facts.far_depth - facts.near_depth) / steps;
    std::vector<std::vector<ShareCosts::RayStep>> by_row(static_cast<std::size_t>(rows));
    parallel_for(rows, 1, [&](std::int64_t row) {
        for (int column = 0; column < columns; ++column) {
            const View::Ray ray =
                view.ray((column + 0.5) * view.width / columns - 0.5,
                         (static_cast<double>(row) + 0.5) * view.height / rows - 0.5);
            const glm::dvec3 origin = facts.grid.to_index(ray.origin);
            const glm::dvec3 direction = facts.grid.direction_to_index(ray.direction);
            const glm::dvec3 walked = glm::abs(step * direction);
            const double length = step * glm::length(ray.direction);
            for (int i = 0; i < steps; ++i) {
                const glm::dvec3 at = origin + (facts.near_depth + (i + 0.5) * step) * direction;
                if (glm::clamp(at, facts.grid.index_min(), facts.grid.index_max()) != at ||
                    cut_away(facts, at))
                    continue;
                const std::size_t brick = facts.occupied_bricks.place_of(at);
                if (facts.occupied_bricks.distance[brick] > 0) continue;
                const double depth =
                    length * mean_extinction(*scene.transfer_function, bricks.range(brick));
                by_row[static_cast<std::size_t>(row)].push_back(
                    {glm::vec3(at), static_cast<float>(walked.x + walked.y + walked.z),
                     static_cast<float>(depth), static_cast<std::int32_t>(row * columns + column)});
            }
        }
    });
    std::vector<ShareCosts::RayStep> all;
    for (const auto& row : by_row) all.insert(all.end(), row.begin(), row.end());
    return all;
}

// Adds the bricks of the cache that are read from files.
void find_pages(const Scene& scene, const Facts& facts, ShareCosts& costs) {
    constexpr double edge = BrickCache::edge;
    const View view(*scene.camera, scene.width, scene.height);
    costs.page_cost = cells_of_page * columns_of(view) / view.width * rows_of(view) / view.height;
    const glm::dvec3 end = facts.grid.index_max();
    for (double z = 0; z < end.z; z += edge) {
        for (double y = 0; y < end.y; y += edge) {
            for (double x = 0; x < end.x; x += edge) {
                const glm::dvec3 first(x, y, z), middle = first + 0.5 * edge;
                if (in_picture(view, facts.grid.to_world(middle)) &&
                    facts.occupied_bricks.any_in(first, first + (edge - 1)))
                    costs.pages.emplace_back(middle);
            }
        }
    }
}

}  // namespace

ShareCosts::Pair ShareCosts::of_sides(int axis, double place) const {
    double cost[2] = {0, 0}, depth[2] = {0, 0};
    for (const glm::vec3& page : pages) cost[page[axis] >= place ? 1 : 0] += page_cost;
    std::int32_t last_ray[2] = {-1, -1};
    for (const RayStep& ray_step : ray_steps) {
        const int side = ray_step.middle[axis] >= place ? 1 : 0;
        if (last_ray[side] != ray_step.ray) {
            last_ray[side] = ray_step.ray;
            depth[side] = 0;
            cost[side] += cells_of_ray;
        }
        if (depth[side] >= opaque_depth) continue;
        depth[side] += ray_step.optical_depth;
        cost[side] += ray_step.cells;
    }
    return {cost[0], cost[1]};
}

ShareCosts ShareCosts::side(int axis, double place, bool above) const {
    ShareCosts result{{}, {}, opaque_depth, page_cost};
    std::ranges::copy_if(
        ray_steps, std::back_inserter(result.ray_steps),
        [&](const RayStep& ray_step) { return (ray_step.middle[axis] >= place) == above; });
    std::ranges::copy_if(pages, std::back_inserter(result.pages),
                         [&](const glm::vec3& page) { return (page[axis] >= place) == above; });
    return result;
}

VolumeShares::VolumeShares(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks,
                           bool in_files, int count) {
    const auto& size = facts.grid.size;
    const glm::dvec3 last(size[0] - 1, size[1] - 1, size[2] - 1);
    ShareCosts costs{
        find_ray_steps(scene, facts, bricks), {}, opaque_depth(scene.max_error, facts.max_color)};
    if (in_files) find_pages(scene, facts, costs);
    divide(costs, {glm::dvec3(-endless), glm::dvec3(endless)}, {glm::dvec3(0), last}, count);
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
    divide(costs.side(cut.axis, cut.place, false), below, between_below, below_of(count));
    divide(costs.side(cut.axis, cut.place, true), above, between_above, count - below_of(count));
}

// Finds on each axis the plane that divides the cost in the ratio of the numbers of boxes, and
// takes the one of the three with the least cost for a renderer. They differ because a box behind
// another one may draw much that the other hides.
VolumeShares::Cut VolumeShares::best_cut(const ShareCosts& costs, const IndexBox& between,
                                         int count) {
    const double below = below_of(count), above = count - below_of(count);
    const glm::dvec3 size = between.max - between.min;
    std::array<int, 3> axes{0, 1, 2};
    std::ranges::stable_sort(axes, std::greater(), [&](int axis) { return size[axis]; });
    // If nothing can be cut, everything is below.
    Cut best{axes[0], between.max[axes[0]] + 1};
    double least = endless;
    for (const int axis : axes) {
        const double unit = size[axis] >= cells_to_cut_finely ? double{MinMaxBricks::edge} : 1.0;
        auto low = static_cast<std::int64_t>(std::floor(between.min[axis] / unit)) + 1;
        auto high = static_cast<std::int64_t>(std::ceil(between.max[axis] / unit)) - 1;
        if (low > high) continue;
        const auto costs_at = [&](std::int64_t number) {
            const double place = static_cast<double>(number) * unit;
            ShareCosts::Pair pair = costs.of_sides(axis, place);
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

// Walks the tree of cuts. The side with the eye, or that parallel rays enter first, is nearer.
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

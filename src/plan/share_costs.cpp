// SPDX-License-Identifier: Apache-2.0
#include "plan/share_costs.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>

#include "base/parallel.h"
#include "facts/ray_shares.h"
#include "scene/camera.h"
#include "volume/brick_cache.h"

namespace lamina {
namespace {

constexpr int rays_along_side = 48, most_steps = 192;

// What a ray costs in each part that shows something on it, in cells: it is set up there, and its
// pixel is composited once more.
constexpr double cells_of_ray = 8;

// What it costs to read a brick of the cache: measured 130 us from a file that the system has in
// its memory, where a cell takes 68 ns.
constexpr double cells_of_page = 1900;

int columns_of(const View& view) {
    return std::min(rays_along_side, view.width);
}
int rows_of(const View& view) {
    return std::min(rays_along_side, view.height);
}

bool in_picture(const View& view, const glm::dvec3& point) {
    const glm::dvec3 way = point - view.eye;
    const double depth = glm::dot(way, view.forward);
    const double half = 0.5 * view.pixel * (view.projection == Projection::perspective ? depth : 1);
    return depth > 0 && std::abs(glm::dot(way, view.right)) < half * view.width &&
           std::abs(glm::dot(way, view.up)) < half * view.height;
}

// The mean over a brick's range of values: how they are distributed is not known.
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

}  // namespace

ShareCosts::ShareCosts(const Scene& scene, const Facts& facts, const MinMaxBricks& bricks,
                       bool in_files)
    : opaque_depth_(lamina::opaque_depth(scene.max_error, facts.max_color)) {
    find_stretches(scene, facts, bricks);
    if (in_files) find_pages(scene, facts);
}

void ShareCosts::find_stretches(const Scene& scene, const Facts& facts,
                                const MinMaxBricks& bricks) {
    const View view(*scene.camera, scene.width, scene.height);
    const int columns = columns_of(view), rows = rows_of(view);
    const int steps = static_cast<int>(
        std::clamp(facts.voxels_along_view / MinMaxBricks::edge, 8.0, double{most_steps}));
    const double step = (facts.far_depth - facts.near_depth) / steps;
    std::vector<std::vector<Stretch>> by_row(static_cast<std::size_t>(rows));
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
    for (const auto& row : by_row) stretches_.insert(stretches_.end(), row.begin(), row.end());
}

void ShareCosts::find_pages(const Scene& scene, const Facts& facts) {
    constexpr double edge = BrickCache::edge;
    const View view(*scene.camera, scene.width, scene.height);
    page_cost_ = cells_of_page * columns_of(view) / view.width * rows_of(view) / view.height;
    const glm::dvec3 end = facts.grid.index_max();
    for (double z = 0; z < end.z; z += edge) {
        for (double y = 0; y < end.y; y += edge) {
            for (double x = 0; x < end.x; x += edge) {
                const glm::dvec3 first(x, y, z), middle = first + 0.5 * edge;
                if (in_picture(view, facts.grid.to_world(middle)) &&
                    facts.occupied_bricks.any_in(first, first + (edge - 1)))
                    pages_.emplace_back(middle);
            }
        }
    }
}

ShareCosts::Pair ShareCosts::of_parts(int axis, double place) const {
    double cost[2] = {0, 0}, depth[2] = {0, 0};
    for (const glm::vec3& page : pages_) cost[page[axis] >= place ? 1 : 0] += page_cost_;
    std::int32_t last_ray[2] = {-1, -1};
    for (const Stretch& stretch : stretches_) {
        const int part = stretch.middle[axis] >= place ? 1 : 0;
        if (last_ray[part] != stretch.ray) {
            last_ray[part] = stretch.ray;
            depth[part] = 0;
            cost[part] += cells_of_ray;
        }
        if (depth[part] >= opaque_depth_) continue;
        depth[part] += stretch.optical_depth;
        cost[part] += stretch.cells;
    }
    return {cost[0], cost[1]};
}

ShareCosts ShareCosts::part(int axis, double place, bool above) const {
    ShareCosts result;
    result.opaque_depth_ = opaque_depth_;
    result.page_cost_ = page_cost_;
    std::ranges::copy_if(
        stretches_, std::back_inserter(result.stretches_),
        [&](const Stretch& stretch) { return (stretch.middle[axis] >= place) == above; });
    return result;
}

}  // namespace lamina

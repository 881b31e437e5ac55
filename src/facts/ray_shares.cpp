// SPDX-License-Identifier: Apache-2.0
#include "facts/ray_shares.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "facts/facts.h"
#include "volume/scattered_samples.h"

namespace lamina {
namespace {

constexpr int rays_along_side = 32, most_steps = 512;

class ShareCounter {
  public:
    ShareCounter(const Scene& scene, const Volume& volume, const Facts& facts)
        : volume_(volume),
          facts_(facts),
          transfer_function_(*scene.transfer_function),
          view_(*scene.camera, scene.width, scene.height),
          opaque_(opaque_depth(scene.max_error, facts.max_color)),
          steps_(static_cast<int>(std::clamp(facts.voxels_along_view, 1.0, double{most_steps}))) {}

    // Counts in steps.
    RayShares count(int column, int row) const {
        const View::Ray ray = view_.ray(column, row);
        const glm::dvec3 origin = facts_.grid.to_index(ray.origin);
        const glm::dvec3 direction = facts_.grid.direction_to_index(ray.direction);
        const double step = (facts_.far_depth - facts_.near_depth) / steps_;
        const double length = step * glm::length(ray.direction);
        RayShares steps;
        double depth = 0;
        for (int i = 0; i < steps_; ++i) {
            const glm::dvec3 at = origin + (facts_.near_depth + (i + 0.5) * step) * direction;
            if (glm::clamp(at, facts_.grid.index_min(), facts_.grid.index_max()) != at) continue;
            if (std::ranges::any_of(
                    facts_.clip, [&](const IndexPlane& plane) { return plane.distance(at) < 0; }))
                continue;
            const bool occupied = facts_.occupied_bricks.any_in(at, at);
            const bool seen = depth < opaque_;
            const bool constant = !facts_.constant_bricks.kinds.empty() &&
                                  !facts_.constant_bricks.varied.any_in(at, at);
            steps.box += 1;
            steps.occupied += occupied;
            steps.constant += constant;
            steps.box_before_opaque += seen;
            steps.occupied_before_opaque += occupied && seen;
            steps.constant_before_opaque += constant && seen;
            if (occupied && seen) depth += length * extinction_near(at);
        }
        return steps;
    }
    int steps() const { return steps_; }

  private:
    // Returns the extinction of the nearest sample.
    double extinction_near(const glm::dvec3& at) const {
        std::array<std::int64_t, 3> place{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto nearest = std::llround(at[static_cast<int>(axis)]);
            place[axis] = std::clamp<std::int64_t>(nearest, 0, volume_.grid().size[axis] - 1);
        }
        const double value = scattered_sample(volume_, place);
        return std::isfinite(value) ? transfer_function_.at(value).extinction : 0;
    }

    const Volume& volume_;
    const Facts& facts_;
    const TransferFunction& transfer_function_;
    View view_;
    double opaque_;
    int steps_;
};

}  // namespace

double opaque_depth(double max_error, double max_color) {
    return -std::log(hidden_share * max_error / (255 * std::max(max_color, 1.0)));
}

RayShares measure_ray_shares(const Scene& scene, const Volume& volume, const Facts& facts) {
    if (facts.far_depth <= facts.near_depth) return {};
    const ShareCounter counter(scene, volume, facts);
    const int columns = std::min(rays_along_side, scene.width);
    const int rows = std::min(rays_along_side, scene.height);
    std::vector<RayShares> found(static_cast<std::size_t>(columns * rows));
    parallel_for(rows, 1, [&](std::int64_t row) {
        for (int column = 0; column < columns; ++column) {
            found[static_cast<std::size_t>(row * columns + column)] =
                counter.count((2 * column + 1) * scene.width / (2 * columns),
                              static_cast<int>((2 * row + 1) * scene.height / (2 * rows)));
        }
    });
    RayShares sum;
    const double all = static_cast<double>(found.size()) * counter.steps();
    for (const RayShares& ray : found) {
        sum.box += ray.box / all;
        sum.occupied += ray.occupied / all;
        sum.constant += ray.constant / all;
        sum.box_before_opaque += ray.box_before_opaque / all;
        sum.occupied_before_opaque += ray.occupied_before_opaque / all;
        sum.constant_before_opaque += ray.constant_before_opaque / all;
    }
    return sum;
}

}  // namespace lamina

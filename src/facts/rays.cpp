// SPDX-License-Identifier: Apache-2.0
#include "facts/volume_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "base/parallel.h"
#include "volume/volume_store.h"

namespace lamina {

namespace {

// Rays along each side of the picture, and most steps along a ray, for RayShares.
constexpr int rays_along_side = 32, most_steps = 512;

// Measures RayShares on single rays.
struct ShareCounter {
    const Scene& scene;
    const Volume& volume;
    const Facts& facts;
    View view{*scene.camera, scene.width, scene.height};
    double opaque = opaque_depth(scene.max_error, facts.max_color);
    int steps = static_cast<int>(std::clamp(facts.voxels_along_view, 1.0, double{most_steps}));

    // Returns the shares of one pixel's ray as numbers of steps, not yet divided by `steps`.
    RayShares count(int column, int row) const {
        const View::Ray ray = view.ray(column, row);
        const glm::dvec3 origin = facts.grid.to_index(ray.origin);
        const glm::dvec3 direction = facts.grid.direction_to_index(ray.direction);
        const double step = (facts.far_depth - facts.near_depth) / steps;
        const double length = step * glm::length(ray.direction);
        RayShares shares;
        double depth = 0;
        for (int i = 0; i < steps; ++i) {
            const glm::dvec3 at = origin + (facts.near_depth + (i + 0.5) * step) * direction;
            if (glm::clamp(at, facts.grid.index_min(), facts.grid.index_max()) != at) continue;
            if (std::ranges::any_of(
                    facts.clip, [&](const IndexPlane& plane) { return plane.distance(at) < 0; }))
                continue;
            const bool occupied = facts.occupied_bricks.any_in(at, at);
            const bool seen = depth < opaque;
            const bool constant = !facts.constant_bricks.kinds.empty() &&
                                  !facts.constant_bricks.varied.any_in(at, at);
            shares.box += 1;
            shares.occupied += occupied;
            shares.constant += constant;
            shares.box_before_opaque += seen;
            shares.occupied_before_opaque += occupied && seen;
            shares.constant_before_opaque += constant && seen;
            if (occupied && seen) depth += length * extinction_near(at);
        }
        return shares;
    }

    double extinction_near(const glm::dvec3& at) const {
        std::array<std::int64_t, 3> place{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double index = at[static_cast<int>(axis)];
            const auto nearest = facts.grid.lookup == VolumeLookup::nearest
                                     ? static_cast<std::int64_t>(std::floor(index))
                                     : std::llround(index);
            place[axis] = std::clamp<std::int64_t>(nearest, 0, volume.grid().size[axis] - 1);
        }
        const double value = scattered_sample(volume, place);
        return std::isfinite(value) ? scene.transfer_function->at(value).extinction : 0;
    }
};

// Sampled pixels along each side for ScalarRays; rays that miss the clipped box are left out.
constexpr int places_along_side = 64;
constexpr double scalars_per_voxel = 4;  // along the view, if RaySampling::scalars allows it

// Samples single rays of ScalarRays. `bricks`: may be null (sample_rays()).
struct RaySampler {
    const Scene& scene;
    const Volume& volume;
    const Facts& facts;
    const MinMaxBricks* bricks;
    double most_scalars;
    const Grid& grid = facts.grid;
    View view{*scene.camera, scene.width, scene.height};
    double step =
        (facts.far_depth - facts.near_depth) /  // depth between two scalars
        std::clamp(std::ceil(scalars_per_voxel * facts.voxels_along_view), 1.0, most_scalars);

    // Returns the depths between which the ray is in the clipped box; far <= near if it misses it.
    DepthRange chord(const glm::ivec2& pixel) const {
        const View::Ray ray = view.ray(pixel.x, pixel.y);
        const glm::dvec3 origin = grid.to_index(ray.origin);
        const glm::dvec3 direction = grid.direction_to_index(ray.direction);
        double from = 0, to = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (grid.index_min()[axis] - origin[axis]) / direction[axis];
            const double b = (grid.index_max()[axis] - origin[axis]) / direction[axis];
            // Parallel to these faces: no limit.
            if (!std::isfinite(a) || !std::isfinite(b)) continue;
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        for (const IndexPlane& plane : facts.clip) {
            const double slope = glm::dot(plane.normal, direction);
            const double at = -plane.distance(origin) / slope;
            if (!std::isfinite(at)) continue;  // parallel to the plane: no limit
            (slope > 0 ? from : to) = slope > 0 ? std::max(from, at) : std::min(to, at);
        }
        return {from, to};
    }

    ScalarRays::Ray sample(const glm::ivec2& pixel) const {
        const auto [near, far] = chord(pixel);
        const int steps =
            static_cast<int>(std::clamp(std::ceil((far - near) / step), 1.0, most_scalars));
        const double width = (far - near) / steps;
        const View::Ray ray = view.ray(pixel.x, pixel.y);
        const glm::dvec3 origin = grid.to_index(ray.origin);
        const glm::dvec3 direction = grid.direction_to_index(ray.direction);
        ScalarRays::Ray result{glm::length(ray.direction), near, far, {}, {}};
        double depth = 0, extinction_before = 0;
        for (int i = 0; i <= steps; ++i) {
            const double scalar = scalar_at(origin + (near + i * width) * direction);
            const double extinction =
                std::isfinite(scalar) ? scene.transfer_function->at(scalar).extinction : 0;
            if (i > 0)
                depth += (extinction_before + extinction) / 2 * width * result.length_per_depth;
            extinction_before = extinction;
            result.scalars.push_back(static_cast<float>(scalar));
            result.optical_depths.push_back(static_cast<float>(depth));
        }
        return result;
    }

    double scalar_at(const glm::dvec3& place) const {
        const glm::dvec3 index = glm::clamp(place, grid.index_min(), grid.index_max());
        const glm::dvec3 cell = glm::floor(index);
        const bool voxels = grid.lookup == VolumeLookup::nearest;
        const glm::dvec3 weight = voxels ? glm::dvec3(0) : index - cell;
        std::array<std::int64_t, 3> lower{}, upper{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const auto at = static_cast<std::int64_t>(cell[axis]);
            lower[i] = std::clamp<std::int64_t>(at, 0, grid.size[i] - 1);
            upper[i] = std::clamp<std::int64_t>(at + 1, 0, grid.size[i] - 1);
        }
        const auto samples = scattered_corners(volume, bricks, lower, upper);
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            double share = 1;
            for (int axis = 3; axis-- > 0;)
                share *= (corner >> axis & 1) == 1 ? weight[axis] : 1 - weight[axis];
            if (share > 0) sum += share * samples[static_cast<std::size_t>(corner)];
        }
        return sum;
    }
};

}  // namespace

double opaque_depth(double max_error, double max_color) {
    return -std::log(hidden_share * max_error / (255 * std::max(max_color, 1.0)));
}

RayShares measure_ray_shares(const Scene& scene, const Volume& volume, const Facts& facts) {
    if (facts.far_depth <= facts.near_depth) return {};
    const ShareCounter counter{scene, volume, facts};
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
    const double all = static_cast<double>(found.size()) * counter.steps;
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

ScalarRays sample_rays(const Scene& scene, const Volume& volume, const Facts& facts,
                       const MinMaxBricks* bricks, const RaySampling& sampling) {
    ScalarRays found;
    if (facts.far_depth <= facts.near_depth) return found;
    const RaySampler sampler{scene, volume, facts, bricks, sampling.scalars};
    const int columns = std::min(places_along_side, scene.width);
    const int rows = std::min(places_along_side, scene.height);
    std::vector<glm::ivec2> pixels;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const glm::ivec2 pixel((2 * column + 1) * scene.width / (2 * columns),
                                   (2 * row + 1) * scene.height / (2 * rows));
            if (const auto [near, far] = sampler.chord(pixel); near < far) pixels.push_back(pixel);
        }
    }
    const std::size_t step = (pixels.size() + sampling.rays - 1) / sampling.rays;
    found.rays.resize(step > 0 ? (pixels.size() + step - 1) / step : 0);
    parallel_for(static_cast<std::int64_t>(found.rays.size()), 4, [&](std::int64_t number) {
        const auto ray = static_cast<std::size_t>(number);
        found.rays[ray] = sampler.sample(pixels[ray * step]);
    });
    return found;
}

}  // namespace lamina

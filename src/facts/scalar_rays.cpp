// SPDX-License-Identifier: Apache-2.0
#include "facts/scalar_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "base/parallel.h"
#include "facts/facts.h"
#include "volume/scattered_samples.h"

namespace lamina {
namespace {

// Pixels on a grid with this many along each side of the picture have a ray if it meets the box.
constexpr int places_along_side = 64;
constexpr double scalars_per_voxel = 4;

class RaySampler {
  public:
    RaySampler(const Scene& scene, const Volume& volume, const Facts& facts,
               const MinMaxBricks* bricks, double most_scalars)
        : volume_(volume),
          bricks_(bricks),
          grid_(facts.grid),
          clip_(facts.clip),
          transfer_function_(*scene.transfer_function),
          view_(*scene.camera, scene.width, scene.height),
          most_scalars_(most_scalars),
          step_((facts.far_depth - facts.near_depth) /
                std::clamp(std::ceil(scalars_per_voxel * facts.voxels_along_view), 1.0,
                           most_scalars_)) {}

    // Returns the depths at which the pixel's ray enters and leaves the clipped box; if far <= near
    // it misses the box.
    DepthRange chord(const glm::ivec2& pixel) const {
        const View::Ray ray = view_.ray(pixel.x, pixel.y);
        const glm::dvec3 origin = grid_.to_index(ray.origin);
        const glm::dvec3 direction = grid_.direction_to_index(ray.direction);
        double from = 0, to = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (grid_.index_min()[axis] - origin[axis]) / direction[axis];
            const double b = (grid_.index_max()[axis] - origin[axis]) / direction[axis];
            if (!std::isfinite(a) || !std::isfinite(b)) continue;  // perpendicular: all or nothing
            from = std::max(from, std::min(a, b));
            to = std::min(to, std::max(a, b));
        }
        for (const IndexPlane& plane : clip_) {
            const double slope = glm::dot(plane.normal, direction);
            const double at = -plane.distance(origin) / slope;
            if (!std::isfinite(at)) continue;  // as above
            (slope > 0 ? from : to) = slope > 0 ? std::max(from, at) : std::min(to, at);
        }
        return {from, to};
    }

    ScalarRays::Ray sample(const glm::ivec2& pixel) const {
        const auto [near, far] = chord(pixel);
        const int steps =
            static_cast<int>(std::clamp(std::ceil((far - near) / step_), 1.0, most_scalars_));
        const double step = (far - near) / steps;
        const View::Ray ray = view_.ray(pixel.x, pixel.y);
        const glm::dvec3 origin = grid_.to_index(ray.origin);
        const glm::dvec3 direction = grid_.direction_to_index(ray.direction);
        ScalarRays::Ray result{glm::length(ray.direction), near, far, {}, {}};
        double depth = 0, extinction_before = 0;
        for (int i = 0; i <= steps; ++i) {
            const double scalar = scalar_at(origin + (near + i * step) * direction);
            const double extinction =
                std::isfinite(scalar) ? transfer_function_.at(scalar).extinction : 0;
            if (i > 0)
                depth += (extinction_before + extinction) / 2 * step * result.length_per_depth;
            extinction_before = extinction;
            result.scalars.push_back(static_cast<float>(scalar));
            result.optical_depths.push_back(static_cast<float>(depth));
        }
        return result;
    }

  private:
    double scalar_at(const glm::dvec3& place) const {
        const glm::dvec3 index = glm::clamp(place, grid_.index_min(), grid_.index_max());
        const glm::dvec3 cell = glm::floor(index), weight = index - cell;
        std::array<std::int64_t, 3> lower{}, upper{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const auto at = static_cast<std::int64_t>(cell[axis]);
            lower[i] = std::clamp<std::int64_t>(at, 0, grid_.size[i] - 1);
            upper[i] = std::clamp<std::int64_t>(at + 1, 0, grid_.size[i] - 1);
        }
        const auto samples = scattered_corners(volume_, bricks_, lower, upper);
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            double share = 1;
            for (int axis = 3; axis-- > 0;)
                share *= (corner >> axis & 1) == 1 ? weight[axis] : 1 - weight[axis];
            if (share > 0) sum += share * samples[static_cast<std::size_t>(corner)];
        }
        return sum;
    }

    const Volume& volume_;
    const MinMaxBricks* bricks_;
    const Grid& grid_;
    const std::vector<IndexPlane>& clip_;
    const TransferFunction& transfer_function_;
    View view_;
    double most_scalars_;
    double step_;  // in depth, between scalars
};

}  // namespace

ScalarRays sample_rays(const Scene& scene, const Volume& volume, const Facts& facts,
                       const MinMaxBricks* bricks, const RaySampling& sampling) {
    ScalarRays found;
    if (facts.far_depth <= facts.near_depth) return found;
    const RaySampler sampler(scene, volume, facts, bricks, sampling.scalars);
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

// SPDX-License-Identifier: Apache-2.0
#include "scene/scalar_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/parallel.h"
#include "scene/facts.h"

namespace lamina {
namespace {

constexpr int rays_along_side = 16;
constexpr double scalars_per_voxel = 2, most_scalars = 1024;

class RaySampler {
  public:
    RaySampler(const Scene& scene, const Volume& volume, const Facts& facts)
        : volume_(volume),
          grid_(facts.grid),
          transfer_function_(scene.transfer_function),
          view_(scene.camera, scene.width, scene.height),
          near_(facts.near_depth),
          count_(static_cast<int>(std::clamp(std::ceil(scalars_per_voxel * facts.voxels_along_view),
                                             2.0, most_scalars))),
          step_((facts.far_depth - facts.near_depth) / (count_ - 1)) {}

    ScalarRays::Ray sample(int column, int row) const {
        const View::Ray ray = view_.ray(column, row);
        const glm::dvec3 origin = grid_.to_index(ray.origin);
        const glm::dvec3 direction = grid_.direction_to_index(ray.direction);
        ScalarRays::Ray result{glm::length(ray.direction), {}, {}};
        double depth = 0, extinction_before = 0;
        for (int i = 0; i < count_; ++i) {
            const double scalar = scalar_at(origin + (near_ + i * step_) * direction);
            const double extinction =
                std::isfinite(scalar) ? transfer_function_.at(scalar).extinction : 0;
            if (i > 0)
                depth += (extinction_before + extinction) / 2 * step_ * result.length_per_depth;
            extinction_before = extinction;
            result.scalars.push_back(static_cast<float>(scalar));
            result.optical_depths.push_back(static_cast<float>(depth));
        }
        return result;
    }

  private:
    double scalar_at(const glm::dvec3& index) const {
        if (glm::clamp(index, grid_.index_min(), grid_.index_max()) != index)
            return std::numeric_limits<double>::quiet_NaN();
        const glm::dvec3 cell = glm::floor(index), weight = index - cell;
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            std::int64_t place = 0;
            double share = 1;
            for (int axis = 3; axis-- > 0;) {
                const int upper = corner >> axis & 1;
                const std::int64_t size = grid_.size[static_cast<std::size_t>(axis)];
                const auto at = static_cast<std::int64_t>(cell[axis]) + upper;
                place = place * size + std::clamp<std::int64_t>(at, 0, size - 1);
                share *= upper == 1 ? weight[axis] : 1 - weight[axis];
            }
            if (share > 0) sum += share * sample_at(place);
        }
        return sum;
    }
    double sample_at(std::int64_t place) const {
        return volume_.visit(
            [&](const auto* samples) { return static_cast<double>(samples[place]); });
    }

    const Volume& volume_;
    const Grid& grid_;
    const TransferFunction& transfer_function_;
    View view_;
    double near_;
    int count_;
    double step_;
};

}  // namespace

ScalarRays sample_rays(const Scene& scene, const Volume& volume, const Facts& facts) {
    ScalarRays found{facts.near_depth, facts.far_depth, {}};
    if (facts.far_depth <= facts.near_depth) return found;
    const RaySampler sampler(scene, volume, facts);
    const int columns = std::min(rays_along_side, scene.width);
    const int rows = std::min(rays_along_side, scene.height);
    found.rays.resize(static_cast<std::size_t>(columns * rows));
    parallel_for(rows, 1, [&](std::int64_t row) {
        for (int column = 0; column < columns; ++column) {
            found.rays[static_cast<std::size_t>(row * columns + column)] =
                sampler.sample((2 * column + 1) * scene.width / (2 * columns),
                               static_cast<int>((2 * row + 1) * scene.height / (2 * rows)));
        }
    });
    std::erase_if(found.rays, [](const ScalarRays::Ray& ray) {
        return std::ranges::none_of(ray.scalars, [](float s) { return std::isfinite(s); });
    });
    return found;
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "slicing/gradient_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"

namespace lamina {
namespace {

// The nearest half-precision number; |value| < 65520.
std::uint64_t half_of(float value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    constexpr std::uint32_t least_normal = 0x38800000u;  // 2^-14
    if (magnitude < least_normal) {
        const float steps = std::nearbyint(std::bit_cast<float>(magnitude) * 0x1p24f);
        return sign | static_cast<std::uint32_t>(steps);
    }
    const std::uint32_t rounded = magnitude + 0xfffu + (magnitude >> 13 & 1u);
    return sign | (rounded - 0x38000000u) >> 13;
}

// So that the steepest gradient of one axis is 2^14 to 2^15.
double scale_of(const Grid& grid, const ValueRange& range) {
    double steepest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] > 1)
            steepest = std::max(steepest, (range.hi - range.lo) / glm::length(grid.step[axis]));
    }
    if (!(steepest > 0) || !std::isfinite(steepest)) return 1;
    return std::exp2(14 - std::floor(std::log2(steepest)));
}

template <typename Sample>
class Differences {
  public:
    Differences(const Grid& grid, const Sample* samples, double scale)
        : samples_(samples), size_(grid.size), stride_{1, size_[0], size_[0] * size_[1]} {
        for (std::size_t axis = 0; axis < 3; ++axis)
            per_step_[axis] = scale / glm::length(grid.step[axis]);
    }

    // At a sample; beyond the last ones the border's repeats.
    std::uint64_t at(std::array<std::int64_t, 3> index) const {
        std::int64_t offset = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            index[axis] = std::clamp<std::int64_t>(index[axis], 0, size_[axis] - 1);
            offset += index[axis] * stride_[axis];
        }
        std::uint64_t packed = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double slope = difference(offset, index[axis], axis) * per_step_[axis];
            packed |= half_of(static_cast<float>(slope)) << (16 * axis);
        }
        return packed;
    }

  private:
    // One-sided beside what is outside or no number.
    double difference(std::int64_t offset, std::int64_t index, std::size_t axis) const {
        const Sample* const here = samples_ + offset;
        const std::int64_t step = stride_[axis];
        const bool below = index > 0 && std::isfinite(static_cast<double>(here[-step]));
        const bool above =
            index + 1 < size_[axis] && std::isfinite(static_cast<double>(here[step]));
        if (below && above)
            return 0.5 * (static_cast<double>(here[step]) - static_cast<double>(here[-step]));
        const auto center = static_cast<double>(*here);
        if (!std::isfinite(center)) return 0;
        if (above) return static_cast<double>(here[step]) - center;
        if (below) return center - static_cast<double>(here[-step]);
        return 0;
    }

    const Sample* samples_;
    std::array<std::int64_t, 3> size_, stride_;
    std::array<double, 3> per_step_{};
};

}  // namespace

GradientMap make_gradient_map(const Volume& volume, const ValueRange& range,
                              const TextureBrick& part) {
    const Grid& grid = volume.grid();
    GradientMap map{scale_of(grid, range), {}};
    map.gradients.resize(static_cast<std::size_t>(part.size[0] * part.size[1] * part.size[2]));
    volume.visit([&](const auto* samples) {
        const Differences differences(grid, samples, map.scale);
        parallel_for(part.size[1] * part.size[2], 64, [&](std::int64_t number) {
            const std::int64_t y = number % part.size[1], z = number / part.size[1];
            std::uint64_t* const row =
                map.gradients.data() + static_cast<std::size_t>(number * part.size[0]);
            for (std::int64_t x = 0; x < part.size[0]; ++x)
                row[x] = differences.at({part.first[0] + x, part.first[1] + y, part.first[2] + z});
        });
    });
    return map;
}

}  // namespace lamina

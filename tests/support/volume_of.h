// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <random>
#include <type_traits>
#include <vector>

#include "lamina/volume.h"

namespace lamina::test {

inline Grid grid_of(const std::array<std::int64_t, 3>& size, Centering centering) {
    Grid grid;
    grid.size = size;
    grid.centering = {centering, centering, centering};
    return grid;
}

// Returns a volume with the samples f(i, j, k).
template <typename Sample = float, typename Function>
Volume volume_of(const Grid& grid, const Function& f) {
    const auto samples = std::make_shared<std::vector<Sample>>();
    for (std::int64_t k = 0; k < grid.size[2]; ++k)
        for (std::int64_t j = 0; j < grid.size[1]; ++j)
            for (std::int64_t i = 0; i < grid.size[0]; ++i)
                samples->push_back(static_cast<Sample>(
                    f(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))));
    constexpr SampleType type = std::is_same_v<Sample, float>           ? SampleType::float32
                                : std::is_same_v<Sample, std::uint16_t> ? SampleType::uint16
                                : std::is_same_v<Sample, std::int16_t>  ? SampleType::int16
                                                                        : SampleType::uint8;
    return Volume(grid, type, std::shared_ptr<const void>(samples, samples->data()));
}

// Returns a volume of random samples from 0 to 255; each seed gives others.
inline Volume noise(const Grid& grid, std::uint32_t seed) {
    std::mt19937 random(seed);
    return volume_of<std::uint8_t>(grid, [&](double, double, double) { return random() % 256; });
}

// Returns the trilinear field at a point of index space, by its definition: a sum over eight
// samples, with the border values repeated.
inline double trilinear_at(const Volume& volume, const glm::dvec3& index) {
    const auto& size = volume.grid().size;
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        std::int64_t offset = 0, stride = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double last = static_cast<double>(size[axis] - 1);
            const double at = std::fmin(std::fmax(index[axis], 0), last);
            const double below = std::fmin(std::floor(at), std::fmax(last - 1, 0));
            const int step = (corner >> axis) & 1;
            weight *= step == 1 ? at - below : 1 - (at - below);
            const auto sample = static_cast<std::int64_t>(std::fmin(below + step, last));
            offset += stride * sample;
            stride *= size[axis];
        }
        if (weight == 0) continue;
        sum += weight * volume.visit([&](const auto* samples) {
            return static_cast<double>(samples[offset]);
        });
    }
    return sum;
}

}  // namespace lamina::test

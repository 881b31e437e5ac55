// SPDX-License-Identifier: Apache-2.0
#include "choice/volume_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <type_traits>

#include "choice/box_corners.h"
#include "choice/shown_cells.h"
#include "facts/facts.h"
#include "volume/code_counts.h"

namespace lamina {
namespace {

// Enough that a share of 1e-4 of the samples is known to 7 percent.
constexpr std::int64_t most_float_samples = std::int64_t{1} << 21;

// Integers are all counted.
template <typename T>
std::vector<WeightedValue> weighted_values(const T* samples, std::int64_t count) {
    const Counts counts = count_codes(samples, count);
    std::vector<WeightedValue> values;
    for (std::size_t code = 0; code < counts.size(); ++code) {
        if (counts[code] > 0)
            values.push_back({static_cast<double>(code) + std::numeric_limits<T>::min(),
                              static_cast<double>(counts[code])});
    }
    return values;
}

// Every step-th sample. The step has no factor in common with the length of a row, so that all
// columns take part.
std::vector<WeightedValue> weighted_values(const float* samples, std::int64_t count,
                                           std::int64_t row) {
    std::int64_t step = (count + most_float_samples - 1) / most_float_samples;
    while (step > 1 && std::gcd(step, row) > 1) ++step;
    std::vector<WeightedValue> values;
    for (std::int64_t i = 0; i < count; i += step) {
        if (std::isfinite(samples[i])) values.push_back({samples[i], 1});
    }
    return values;
}

}  // namespace

double VolumeField::spacing() const {
    const Grid& grid = volume_.grid();
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] > 1) smallest = std::min(smallest, glm::length(grid.step[axis]));
    }
    return smallest;
}

ValueDistribution VolumeField::distribution() const {
    const std::int64_t count = volume_.grid().sample_count();
    return ValueDistribution(volume_.visit([&](const auto* samples) {
        if constexpr (std::is_same_v<decltype(samples), const float*>)
            return weighted_values(samples, count, volume_.grid().size[0]);
        else
            return weighted_values(samples, count);
    }));
}

std::vector<glm::dvec3> VolumeField::shown_points(const TransferFunction& transfer_function,
                                                  double least) const {
    return hull_of_shown_cells(volume_, bricks_, [&](const ValueRange& range) {
        return transfer_function.max_extinction(range.lo, range.hi) > least;
    });
}

std::array<glm::dvec3, 8> VolumeField::corners() const {
    const Grid& grid = volume_.grid();
    std::array<glm::dvec3, 8> corners = corners_of(grid.index_min(), grid.index_max());
    for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    return corners;
}

std::vector<double> VolumeField::optical_depths(const Scene& scene) const {
    Facts facts;
    facts.grid = volume_.grid();
    measure_view(scene, facts);
    std::vector<double> depths;
    for (const ScalarRays::Ray& ray : sample_rays(scene, volume_, facts).rays)
        depths.push_back(ray.optical_depths.back());
    return depths;
}

}  // namespace lamina

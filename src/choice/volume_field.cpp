// SPDX-License-Identifier: Apache-2.0
#include "choice/volume_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "choice/large_volume.h"
#include "choice/shown_cells.h"
#include "facts/facts.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

std::vector<WeightedValue> weighted(const ValueCounts& counted, SampleType type) {
    const double lowest =
        type == SampleType::int16 ? double{std::numeric_limits<std::int16_t>::min()} : 0;
    std::vector<WeightedValue> values;
    for (std::size_t code = 0; code < counted.codes.size(); ++code) {
        if (counted.codes[code] > 0)
            values.push_back(
                {static_cast<double>(code) + lowest, static_cast<double>(counted.codes[code])});
    }
    for (const float value : counted.some) values.push_back({value, 1});
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
    return ValueDistribution(
        weighted(values_ != nullptr ? *values_ : count_values(volume_), volume_.type()));
}

std::vector<glm::dvec3> VolumeField::shown_points(const TransferFunction& transfer_function,
                                                  double least) const {
    return hull_of_shown_cells(volume_, bricks_, [&](const ValueRange& range) {
        return transfer_function.max_extinction(range.lo, range.hi) > least;
    });
}

std::array<glm::dvec3, 8> VolumeField::corners() const {
    const Grid& grid = volume_.grid();
    std::array<glm::dvec3, 8> corners = box_corners(grid.index_min(), grid.index_max());
    for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    return corners;
}

std::vector<double> VolumeField::optical_depths(const Scene& scene) const {
    Facts facts;
    facts.grid = volume_.grid();
    measure_view(scene, facts);
    const bool large = volume_.grid().sample_count() > large_volume;
    const RaySampling sampling = large ? RaySampling{256, 256} : RaySampling{};
    std::vector<double> depths;
    for (const ScalarRays::Ray& ray : sample_rays(scene, volume_, facts, &bricks_, sampling).rays)
        depths.push_back(ray.optical_depths.back());
    return depths;
}

}  // namespace lamina

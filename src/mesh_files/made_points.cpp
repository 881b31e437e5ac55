// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/made_points.h"

#include <algorithm>

#include "base/error.h"

namespace lamina {

std::int32_t MadePoints::add(std::span<const std::int32_t> sources,
                             std::span<const double> weights) {
    if (mesh_.points.size() >= most_points)
        fail("cells need more points than the {} that a mesh may have", most_points);
    glm::dvec3 place(0);
    for (std::size_t i = 0; i < sources.size(); ++i)
        place += weights[i] * mesh_.points[static_cast<std::size_t>(sources[i])];
    mesh_.points.push_back(place);
    if (places_.known()) places_.look();
    sources_.insert(sources_.end(), sources.begin(), sources.end());
    weights_.insert(weights_.end(), weights.begin(), weights.end());
    ends_.push_back(sources_.size());
    ++mesh_.cells.made_points;
    return static_cast<std::int32_t>(mesh_.points.size() - 1);
}

std::int32_t MadePoints::middle_of(const std::array<std::int32_t, 8>& face) {
    constexpr std::array<double, 8> weights{-.25, -.25, -.25, -.25, .5, .5, .5, .5};
    auto key = face;
    const auto rank = [&](std::int32_t point) { return std::pair(places_.of(point), point); };
    std::ranges::sort(std::span(key).first(4), {}, rank);
    std::ranges::sort(std::span(key).last(4), {}, rank);
    const auto [found, is_new] = middles_.try_emplace(key, 0);
    if (is_new) found->second = add(key, weights);
    return found->second;
}

void MadePoints::append_values() {
    for (MeshScalar& scalar : mesh_.point_scalars) {
        std::size_t at = 0;
        for (const std::size_t end : ends_) {
            double value = 0;
            for (; at < end; ++at)
                value += weights_[at] * scalar.values[static_cast<std::size_t>(sources_[at])];
            scalar.values.push_back(value);
        }
    }
    sources_.clear();
    weights_.clear();
    ends_.clear();
}

}  // namespace lamina

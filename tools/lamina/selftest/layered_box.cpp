// SPDX-License-Identifier: Apache-2.0
#include "selftest/layered_box.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/unreachable.h"

namespace lamina::selftest {
namespace {

template <typename Sample>
std::shared_ptr<const void> fill(const LayeredBox& box) {
    const std::int64_t across = box.samples_across[0] * box.samples_across[1];
    auto values = std::make_shared<std::vector<Sample>>();
    values->reserve(static_cast<std::size_t>(across) * box.samples.size());
    for (const double sample : box.samples)
        values->insert(values->end(), static_cast<std::size_t>(across),
                       static_cast<Sample>(sample));
    return {values, values->data()};
}

}  // namespace

Volume LayeredBox::volume() const {
    Grid grid;
    grid.size = {samples_across[0], samples_across[1], static_cast<std::int64_t>(samples.size())};
    grid.origin = corner;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<double>(grid.size[axis]);
        grid.centering[axis] = Centering::node;
        grid.step[axis] = n > 1 ? edges[axis] / (n - 1) : edges[axis];
        // One sample lies in the middle of its voxel.
        if (grid.size[axis] == 1) grid.origin += 0.5 * edges[axis];
    }
    switch (type) {
        case SampleType::uint8:
            return {grid, type, fill<std::uint8_t>(*this)};
        case SampleType::int16:
            return {grid, type, fill<std::int16_t>(*this)};
        case SampleType::uint16:
            return {grid, type, fill<std::uint16_t>(*this)};
        case SampleType::float32:
            return {grid, type, fill<float>(*this)};
    }
    unreachable_enum();
}

glm::dvec3 LayeredBox::world(const glm::dvec3& place) const {
    return corner + place.x * edges[0] + place.y * edges[1] + place.z * edges[2];
}

glm::dvec3 LayeredBox::place(const glm::dvec3& world) const {
    const glm::dvec3 from_corner = world - corner;
    glm::dvec3 place{0};
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3& edge = edges[static_cast<std::size_t>(axis)];
        place[axis] = glm::dot(from_corner, edge) / glm::dot(edge, edge);
    }
    return place;
}

double LayeredBox::longest_edge() const {
    return std::max({glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2])});
}

std::size_t LayeredBox::layer_at(double w) const {
    const auto count = static_cast<double>(layers());
    return static_cast<std::size_t>(std::clamp(std::floor(w * count), 0.0, count - 1));
}

double LayeredBox::layer_begin(std::size_t layer) const {
    return static_cast<double>(layer) / static_cast<double>(layers());
}

double LayeredBox::scalar(std::size_t layer, double w) const {
    if (samples.size() == 1) return samples[0];
    const double along =
        std::clamp(w * static_cast<double>(layers()) - static_cast<double>(layer), 0.0, 1.0);
    const double a = samples[layer], b = samples[layer + 1];
    return a == b ? a : a * (1 - along) + b * along;
}

bool LayeredBox::is_void(std::size_t layer) const {
    return !std::isfinite(samples[layer]) ||
           (samples.size() > 1 && !std::isfinite(samples[layer + 1]));
}

Interval LayeredBox::range() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Interval range{infinity, -infinity};
    for (const double sample : samples) {
        if (std::isfinite(sample)) range.include(sample);
    }
    return range;
}

std::optional<BoxChord> box_chord(const LayeredBox& box, const View::Ray& ray, double slack) {
    BoxChord chord;
    chord.start = box.place(ray.origin);
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3& edge = box.edges[static_cast<std::size_t>(axis)];
        chord.step[axis] = glm::dot(ray.direction, edge) / glm::dot(edge, edge);
    }
    chord.world_per_parameter = glm::length(ray.direction);
    double begin = 0, end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = -slack - chord.start[axis], hi = 1 + slack - chord.start[axis];
        if (chord.step[axis] == 0) {
            if (lo > 0 || hi < 0) return {};
            continue;
        }
        const double a = lo / chord.step[axis], b = hi / chord.step[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    for (const ClipPlane& cut : box.cuts) {
        const glm::dvec3 normal = glm::normalize(cut.normal);
        const double inside = glm::dot(normal, ray.origin - cut.point) + slack * box.longest_edge();
        const double slope = glm::dot(normal, ray.direction);
        if (slope == 0) {
            if (inside < 0) return {};
        } else if (slope > 0) {
            begin = std::max(begin, -inside / slope);
        } else {
            end = std::min(end, -inside / slope);
        }
    }
    if (!(begin < end)) return {};
    chord.parameters = {begin, end};
    return chord;
}

}  // namespace lamina::selftest

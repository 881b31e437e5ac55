// SPDX-License-Identifier: Apache-2.0
#include "projection/stored_gradients.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

namespace lamina {
namespace {

double largest_component(const glm::dvec3& g) {
    return std::max({std::abs(g.x), std::abs(g.y), std::abs(g.z)});
}

// Gradients longer than so many usual or smallest ones do not count for the unit, so that usual ones
// have room for their squares.
constexpr double most_usual = 0x1p44;

// Longer ones, in the unit, are shortened: float32 has no larger numbers.
constexpr double longest = 0x1p120;

// Returns the median, without those of no length.
double usual_length(std::span<const glm::dvec3> gradients) {
    std::vector<double> lengths;
    lengths.reserve(gradients.size());
    for (const glm::dvec3& g : gradients) {
        if (const double length = largest_component(g); length > 0) lengths.push_back(length);
    }
    if (lengths.empty()) return 0;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    return *middle;
}

}  // namespace

StoredGradients::StoredGradients(std::span<const glm::dvec3> gradients, double smallest) {
    // The largest component, because squares may not be numbers.
    double largest = 0;
    for (const glm::dvec3& g : gradients) largest = std::max(largest, largest_component(g));
    const double most = most_usual * std::max(smallest, usual_length(gradients));
    largest = std::min(largest, most);
    // A length is less than twice that. Beyond the limits all or nothing is lit.
    if (largest > 0)
        scale = std::exp2(std::clamp(-std::ceil(std::log2(largest)) - 1, -1000., 1000.));
    at_points.reserve(gradients.size());
    for (const glm::dvec3& g : gradients) {
        const double length = largest_component(g) * scale;
        at_points.emplace_back(length > longest ? g * scale * (longest / length) : g * scale);
    }
}

float StoredGradients::smallest_square(const Lighting& lighting) const {
    const double smallest = std::clamp(*lighting.smallest_gradient * scale, 1e-15, 1e15);
    return static_cast<float>(smallest * smallest);
}

}  // namespace lamina

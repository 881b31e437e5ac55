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

// Exponent of the smallest gradient in the unit, which is 2^-40 or up to twice that. Light depends
// on the lengths of gradients relative to it, and its square, 2^-80, leaves room for those that are
// 2^20 times as short.
constexpr int smallest_exponent = -40;

// Length, in the unit, to which longer gradients are shortened: float32 has no larger numbers.
constexpr double longest = 0x1p120;

}  // namespace

StoredGradients::StoredGradients(std::span<const glm::dvec3> gradients, double smallest) {
    if (smallest > 0)
        scale = std::ldexp(1.0, std::clamp(smallest_exponent - std::ilogb(smallest), -1000, 1000));
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

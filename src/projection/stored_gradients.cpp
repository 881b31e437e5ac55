// SPDX-License-Identifier: Apache-2.0
#include "projection/stored_gradients.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace lamina {

StoredGradients::StoredGradients(std::span<const glm::dvec3> gradients) {
    // The largest component, because squares may not be numbers.
    double largest = 0;
    for (const glm::dvec3& g : gradients)
        largest = std::max({largest, std::abs(g.x), std::abs(g.y), std::abs(g.z)});
    // A length is less than twice that. Beyond the limits all or nothing is lit.
    if (largest > 0)
        scale = std::exp2(std::clamp(-std::ceil(std::log2(largest)) - 1, -1000., 1000.));
    at_points.reserve(gradients.size());
    for (const glm::dvec3& g : gradients) at_points.emplace_back(g * scale);
}

float StoredGradients::smallest_square(const Lighting& lighting) const {
    const double smallest = std::clamp(*lighting.smallest_gradient * scale, 1e-15, 1e15);
    return static_cast<float>(smallest * smallest);
}

}  // namespace lamina

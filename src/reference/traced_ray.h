// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>

namespace lamina {

// The result of a ray.
struct TracedRay {
    glm::dvec4 rgba{0};  // associated
    double error_estimate = 0;
    std::int64_t segments = 0;
};

}  // namespace lamina

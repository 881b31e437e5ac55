// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace lamina::python {

using Vector = std::array<double, 3>;

inline glm::dvec3 to_glm(const Vector& v) {
    return {v[0], v[1], v[2]};
}
inline Vector from_glm(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

}  // namespace lamina::python

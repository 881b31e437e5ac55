// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace lamina {

inline nlohmann::ordered_json json_vector(const glm::dvec3& vector) {
    return nlohmann::ordered_json::array({vector.x, vector.y, vector.z});
}

}  // namespace lamina

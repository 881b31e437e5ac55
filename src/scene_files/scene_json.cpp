// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_json.h"

#include <nlohmann/json.hpp>

#include "scene_files/scene_keys.h"

namespace lamina {

nlohmann::ordered_json transfer_function_json(const TransferFunction& transfer_function) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const TransferKnot& knot : transfer_function.knots()) {
        const glm::dvec3& color = knot.optics.color;
        points.push_back({{"value", knot.value},
                          {"color", {color.r, color.g, color.b}},
                          {"extinction", knot.optics.extinction}});
        if (knot.smooth) points.back()["smooth"] = true;
    }
    return {{"points", points}};
}

nlohmann::ordered_json camera_json(const Camera& camera) {
    return camera_keys().json(camera);
}

nlohmann::ordered_json scene_json(const Scene& scene) {
    return scene_keys().json(scene);
}

}  // namespace lamina

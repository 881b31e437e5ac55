// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene_files/keys.h"
#include "scene_files/scene_reader.h"

namespace lamina {

// Returns the smallest scene: every key that may be left out is left out.
inline nlohmann::json minimal_scene() {
    return nlohmann::json::parse(R"({
        "version": 1,
        "volume": {"generate": "gaussians", "size": [16, 16, 16]},
        "transfer_function": {"points": [{"value": 0, "extinction": 0}, {"value": 255, "opacity": 0.5}]},
        "camera": {"eye": [2, 1, 3], "center": [0.5, 0.5, 0.5]},
        "image": {"width": 32, "height": 24}
    })");
}

inline nlohmann::json with(const std::string& pointer, nlohmann::json value) {
    nlohmann::json scene = minimal_scene();
    scene[nlohmann::json::json_pointer(pointer)] = std::move(value);
    return scene;
}

}  // namespace lamina

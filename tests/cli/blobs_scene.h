// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace lamina {

// A small coloured volume with a mesh of tolerance .1, to be sliced with `samples` slabs.
inline nlohmann::json blobs_scene(int width, int height, int samples) {
    auto scene = nlohmann::json::parse(R"({
        "version": 1,
        "volume": {"generate": "gaussians", "size": [16, 16, 16]},
        "mesh": {"tolerance": 0.1},
        "transfer_function": {"points": [
            {"value": 0, "color": [0, 0, 1], "extinction": 0},
            {"value": 255, "color": [1, 0.5, 0], "extinction": 8}]},
        "camera": {"eye": [1.7, -0.9, 1.3], "center": [0.5, 0.5, 0.5], "up": [0, 0, 1]}})");
    scene["image"] = {{"width", width}, {"height", height}};
    scene["render"]["slice"]["samples"] = samples;
    return scene;
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace lamina {

// Returns a scene of a coloured volume of edge^3 samples, sliced with `samples` slabs.
inline nlohmann::json gaussians_scene(int edge, int width, int height, int samples) {
    auto scene = nlohmann::json::parse(R"({
        "version": 1,
        "volume": {"generate": "gaussians"},
        "transfer_function": {"points": [
            {"value": 0, "color": [0, 0, 1], "extinction": 0},
            {"value": 255, "color": [1, 0.5, 0], "extinction": 8}]},
        "camera": {"eye": [1.7, -0.9, 1.3], "center": [0.5, 0.5, 0.5], "up": [0, 0, 1]}})");
    scene["volume"]["size"] = {edge, edge, edge};
    scene["image"] = {{"width", width}, {"height", height}};
    scene["render"]["slice"]["samples"] = samples;
    return scene;
}

// Returns such a scene of 16^3 samples with a mesh of tolerance .1.
inline nlohmann::json blobs_scene(int width, int height, int samples) {
    auto scene = gaussians_scene(16, width, height, samples);
    scene["mesh"] = {{"tolerance", 0.1}};
    return scene;
}

}  // namespace lamina

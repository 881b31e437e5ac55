// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lamina/lighting.h"

namespace lamina {

struct Scene;

// Largest coordinate of lights, in world units: squares of distances far beyond it would overflow.
inline constexpr double largest_scene_coordinate = 1e100;

// A part of a lighting that cannot be drawn.
struct LightingMistake {
    std::string key;      // "power", "lights.2.direction"
    std::string message;  // "found 0, expected ..."
};
std::optional<LightingMistake> mistake_in(const Lighting& lighting);

// Throws Error for the scene's lighting, if it has any that cannot be drawn.
void check_lighting(const Scene& scene);

}  // namespace lamina

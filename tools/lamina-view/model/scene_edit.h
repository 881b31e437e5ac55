// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <nlohmann/json.hpp>
#include <string>

#include "lamina/image_color_space.h"
#include "lamina/scene.h"

namespace lamina::view {

// The contents of the scene's file, with every key written out. The transfer function, which is
// edited by itself, is "auto" in it.
nlohmann::ordered_json settings_of(const Scene& scene);

// Returns the scene with another value of a key, one of those that settings_of() has. `path` has
// the indices of list elements: "clip.planes.0.normal". null removes the key. The scene is checked
// like scene files: throws Error.
Scene with_setting(const Scene& scene, const std::string& path,
                   const nlohmann::ordered_json& value);

// Returns the value at a path of settings_of(); null if there is none.
nlohmann::ordered_json setting_at(const nlohmann::ordered_json& settings, const std::string& path);

// Converts a colour to the numbers of another space. Components above 1 are kept.
glm::dvec3 converted_color(const glm::dvec3& color, ImageColorSpace from, ImageColorSpace to);

}  // namespace lamina::view

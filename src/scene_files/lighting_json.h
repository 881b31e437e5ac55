// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/image_color_space.h"
#include "lamina/lighting.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads "lighting" (docs/scene.md); none where the scene has none. Throws KeyError.
std::optional<Lighting> read_lighting(JsonReader& scene, ImageColorSpace space);

nlohmann::ordered_json lighting_json(const Lighting& lighting);

}  // namespace lamina

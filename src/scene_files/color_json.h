// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scene_files/json_reader.h"

namespace lamina {

// Reads a colour (docs/scene.md): three numbers of the reader's colour space, or display values,
// which are converted to it: "#rrggbb", a CSS name, or {"srgb": [r, g, b]}. Throws KeyError.
glm::dvec3 read_color(JsonReader& reader, const std::string& key);

}  // namespace lamina

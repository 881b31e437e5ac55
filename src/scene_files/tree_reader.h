// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/tree_settings.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads "tree" of "render.slice" or "render.project" (docs/scene.md), if it is there.
std::optional<TreeSettings> read_tree(JsonReader& method);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/setting_node.h"

namespace lamina::view {

// The text of docs/scene.schema.json.
std::string_view scene_schema();

// The group of all keys of scene files, read from the schema: each key has a node.
const SettingNode& scene_keys();

// Returns the paths below a node, without its own.
std::vector<std::string> paths_below(const SettingNode& node);

// Returns the node of a path without numbers, "clip.planes[].point"; it must exist.
const SettingNode& scene_key(std::string_view path);

}  // namespace lamina::view

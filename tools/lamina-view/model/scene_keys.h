// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/setting_node.h"

namespace lamina::view {

// The text of docs/scene.schema.json.
std::string_view scene_schema();

// All keys of scene files, read from the schema: what has a key there has a node here. The group of
// the whole scene.
const SettingNode& scene_keys();

// The paths below a node, its own left out.
std::vector<std::string> paths_below(const SettingNode& node);

// The node of a path without numbers, "clip.planes[].point"; it must be there.
const SettingNode& scene_key(std::string_view path);

}  // namespace lamina::view

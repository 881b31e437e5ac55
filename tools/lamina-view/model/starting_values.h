// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lamina/grid.h"
#include "lamina/scene.h"
#include "model/setting_node.h"

namespace lamina::view {

// Returns true if a scene may lack this group of keys, so that it can be switched on and off.
bool may_be_absent(const SettingNode& node);

// Returns a key's value when it is switched on, or no longer automatic: the value that was chosen
// for it (`resolved`, may be null), else its default, else a value that can be drawn. `bounds`: the
// data's, if they are known. `path` contains the indices of list elements.
nlohmann::ordered_json starting_value(const SettingNode& node, const std::string& path,
                                      const Scene& scene, const Scene* resolved,
                                      const std::optional<Grid::Bounds>& bounds);

}  // namespace lamina::view

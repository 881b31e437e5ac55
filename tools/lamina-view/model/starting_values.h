// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lamina/grid.h"
#include "lamina/scene.h"
#include "model/setting_node.h"

namespace lamina::view {

// Whether a scene may be without this group of keys, so that it is switched on and off.
bool may_be_absent(const SettingNode& node);

// What a key begins with when it is switched on, or no longer automatic: what was chosen for it
// (`resolved`, may be null), else its default, else something that can be drawn. `bounds`: of the
// data, where they are known. `path` has the numbers of elements.
nlohmann::ordered_json starting_value(const SettingNode& node, const std::string& path,
                                      const Scene& scene, const Scene* resolved,
                                      const std::optional<Grid::Bounds>& bounds);

}  // namespace lamina::view

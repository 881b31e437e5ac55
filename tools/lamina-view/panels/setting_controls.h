// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "lamina/image_color_space.h"
#include "model/setting_node.h"

namespace lamina::view {

// The control of a value that is no group: shows `value` (of the scene's file) at the cursor, as
// wide as the line. Returns another value if the user gave one; the scene's reader judges it.
std::optional<nlohmann::ordered_json> setting_control(const SettingNode& node,
                                                      const nlohmann::ordered_json& value,
                                                      ImageColorSpace space);

}  // namespace lamina::view

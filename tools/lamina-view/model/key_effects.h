// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "lamina/scene.h"

namespace lamina::view {

// Returns why a key changes nothing in this scene ("counts with the target emulated"); empty if it
// may change something. `path` is that of a SettingNode.
std::string why_without_effect(const Scene& scene, std::string_view path);

}  // namespace lamina::view

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lamina/scene.h"

namespace lamina {

// Data in memory, which a scene draws instead of what it names.
enum class GivenData { none, volume, mesh };

// Reads the scene in `document`. `file` is for messages and relative paths. Throws KeyError
// (scene_files/json_reader.h).
Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 GivenData given = GivenData::none);

// Sets `key` ("render.slice.samples", list elements by number) to `value`, which is JSON where it
// parses as JSON and a string otherwise; null removes the key. Throws UsageError where the path
// leads through a value that is neither an object nor a list.
void set_key(nlohmann::json& document, const std::string& key, const std::string& value);

// Removes `key` from the object that contains it. A document without the key stays as it is. Throws
// UsageError where the key has an empty component.
void remove_key(nlohmann::json& document, const std::string& key);

}  // namespace lamina

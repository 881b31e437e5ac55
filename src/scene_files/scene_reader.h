// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// The scene in `document`; `file` is for messages and relative paths. Throws KeyError
// (scene_files/json_reader.h). `known`: collects the path of every key that the reader asks for, or
// null.
Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 std::set<std::string>* known = nullptr);

// Sets `key` ("render.slice.samples", list elements by number) to `value`: JSON where it parses as
// JSON, else a string. Throws UsageError when the path leads through something that is no object or
// list.
void set_key(nlohmann::json& document, const std::string& key, const std::string& value);

// Takes `key` out of the object that it is in; a document without it stays as it is. Throws
// UsageError where the key has an empty part.
void remove_key(nlohmann::json& document, const std::string& key);

}  // namespace lamina

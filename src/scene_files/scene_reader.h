// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Returns the JSON of a scene file or, for a data file, of a scene that draws it, all else
// automatic and cells with NaN transparent. `request`: selects a volume of the data file.
nlohmann::json scene_document(const std::filesystem::path& file, const VolumeRequest& request = {});

// Returns a scene file with every key (docs/scene.md), which read_scene() reads as an equal scene:
// paths absolute, numbers exact, transfer functions as points, unless their colour map is open.
nlohmann::ordered_json scene_json(const Scene& scene);

// Return the values of the keys "transfer_function" and "camera".
nlohmann::ordered_json transfer_function_json(const TransferFunction& transfer_function);
nlohmann::ordered_json camera_json(const Camera& camera);

// Kind of the data in memory that a scene draws instead of those it names.
enum class GivenData { none, volume, mesh };

// Reads the scene in `document`. `file`: for messages and relative paths. Throws KeyError.
Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 GivenData given = GivenData::none);

// Sets `key` ("render.slice.samples", list elements by number) to `value`: JSON or else a string;
// null removes the key. Throws UsageError if a part of the path names a value without members.
void set_key(nlohmann::json& document, const std::string& key, const std::string& value);

// Removes `key` if it exists. Throws UsageError if a part between dots is empty.
void remove_key(nlohmann::json& document, const std::string& key);

}  // namespace lamina

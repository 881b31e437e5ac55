// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Returns the JSON of a scene file; for a data file, a scene that draws it: all else is automatic,
// and cells with NaN are transparent. `request`: the part of a volume's file that is wanted.
nlohmann::json scene_document(const std::filesystem::path& file, const VolumeRequest& request = {});

// Returns a scene file (docs/scene.md) with every key written out, from which read_scene() makes an
// equal scene: paths are absolute, numbers have all their digits, and the transfer function is its
// points, except for a colour map that is to be stretched over the data.
nlohmann::ordered_json scene_json(const Scene& scene);

// Return the values of the keys "transfer_function" and "camera".
nlohmann::ordered_json transfer_function_json(const TransferFunction& transfer_function);
nlohmann::ordered_json camera_json(const Camera& camera);

// Data in memory, which a scene draws instead of what it names.
enum class GivenData { none, volume, mesh };

// Reads the scene in `document`. `file`: for messages and relative paths. Throws KeyError.
Scene read_scene(const nlohmann::json& document, const std::filesystem::path& file,
                 GivenData given = GivenData::none);

// Sets `key` ("render.slice.samples", list elements by number) to `value`, JSON or else a string;
// null removes the key. Throws UsageError if the path leads through a value without members.
void set_key(nlohmann::json& document, const std::string& key, const std::string& value);

// Removes `key`, if it is there. Throws UsageError if it has an empty component.
void remove_key(nlohmann::json& document, const std::string& key);

}  // namespace lamina

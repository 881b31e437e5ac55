// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lamina/volume_request.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads the keys of a scene's volume object beside `path`, and closes it: array, level, channel,
// time, spacing, origin; size, type, offset and endian of a raw file. Throws KeyError.
VolumeRequest read_volume_selection(JsonReader& reader);

// The scene's "volume": the path alone where nothing is selected.
nlohmann::ordered_json volume_selection_json(const std::string& path,
                                             const VolumeRequest& selection);

}  // namespace lamina

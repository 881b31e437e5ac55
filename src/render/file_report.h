// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lamina/volume.h"

namespace lamina {

// Tells if a data file is a volume, not a mesh. Throws Error if it is neither.
bool is_volume_data(const std::string& file, const VolumeRequest& request);

// Describes a data file (docs/info.md): the part that the request chooses; request.time is a mesh's
// step, too. Writes a picture to `png` unless that is empty. Throws Error.
nlohmann::ordered_json file_report(const std::string& file, const VolumeRequest& request,
                                   const std::string& png = {});

}  // namespace lamina

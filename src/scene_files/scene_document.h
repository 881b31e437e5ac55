// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "lamina/data_files.h"

namespace lamina {

// The JSON of a scene file; of a data file, a scene that draws it: all else is automatic, and cells
// with NaN are transparent. `request`: what of a volume's file is wanted.
nlohmann::json scene_document(const std::filesystem::path& file, const VolumeRequest& request = {});

}  // namespace lamina

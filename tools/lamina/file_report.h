// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lamina/volume_request.h"

namespace lamina {

// Reports of `lamina info FILE` (docs/meshes.md), and the picture that it writes to `png` unless
// that is empty. Throw Error.
nlohmann::ordered_json report_on_volume(const std::string& file, const std::string& png,
                                        const VolumeRequest& request);
nlohmann::ordered_json report_on_mesh(const std::string& file, const std::string& png);

}  // namespace lamina

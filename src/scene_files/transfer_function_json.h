// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/transfer_function.h"
#include "scene_files/json_reader.h"

namespace lamina {

// The object "transfer_function" of scene files and of `lamina integrate` (docs/scene.md);
// closes the reader. `warnings` collects what the user should know and that is no error, or is
// null.
TransferFunction read_transfer_function(JsonReader reader,
                                        std::vector<std::string>* warnings = nullptr);

}  // namespace lamina

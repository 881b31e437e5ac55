// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/transfer_function.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads the object "transfer_function" of scene files and of `lamina integrate` (docs/scene.md),
// and closes the reader. `warnings`: collects remarks for the user that are no errors, or null.
TransferFunction read_transfer_function(JsonReader reader,
                                        std::vector<std::string>* warnings = nullptr);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lamina/image_color_space.h"
#include "lamina/transfer_function.h"
#include "scene_files/json_reader.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// What a transfer function depends on beside its object.
struct TransferFunctionSurroundings {
    ImageColorSpace space = ImageColorSpace::linear;
    // Gives the range of the data. It is called only where a colour map is stretched over that;
    // null: there are no data.
    std::function<ValueRange()> data_range = {};
    // Collects remarks for the user that are no errors, or null.
    std::vector<std::string>* warnings = nullptr;
};

// Reads the object "transfer_function" of scene files and of `lamina integrate` (docs/scene.md),
// and closes the reader.
TransferFunction read_transfer_function(JsonReader reader,
                                        const TransferFunctionSurroundings& surroundings);

// The file that its colour map is read from; empty: none, or a map that lamina has with it.
std::filesystem::path colormap_file_of(JsonReader& transfer_function);

}  // namespace lamina

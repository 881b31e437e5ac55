// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lamina/transfer_function.h"
#include "scene_files/json_reader.h"

namespace lamina {

// A segment that `lamina integrate` integrates.
struct IntegrationCase {
    TransferFunction transfer_function;
    double front = 0, back = 0;           // scalars, up to 1e300
    double length = 0;                    // world units, >= 0
    std::filesystem::path colormap_file;  // of the transfer function; empty: none
};

// Reads {"transfer_function", "sf", "sb", "length"} and closes the reader. `warnings`: as in
// TransferFunctionSurroundings.
IntegrationCase read_integration_case(JsonReader reader, std::vector<std::string>* warnings);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/scene.h"
#include "scene/given_transfer.h"
#include "scene_files/json_reader.h"
#include "scene_files/keys.h"

namespace lamina {

// The keys of the object "transfer_function" of scene files and of `lamina integrate`
// (docs/scene.md).
const KeyTable<GivenTransfer>& transfer_keys();

// A transfer function as a file gives it, and the function that it means: none if its colour map is
// open.
struct ReadTransfer {
    GivenTransfer given;
    std::optional<TransferFunction> function;
};

// Reads that object, and closes the reader; colours are of its colour space. Throws KeyError, also
// if points and map make no function.
ReadTransfer read_transfer_function(JsonReader reader);

// Adds "transfer_function" to the scene's keys.
void add_transfer_function(KeyTable<Scene>& scene);

// A segment that `lamina integrate` integrates.
struct IntegrationCase {
    TransferFunction transfer_function;
    GivenTransfer given;
    double front = 0, back = 0;  // scalars, up to 1e300
    double length = 0;           // world units, >= 0
};

// Reads {"transfer_function", "sf", "sb", "length"} and closes the reader. Throws KeyError.
IntegrationCase read_integration_case(JsonReader reader);

}  // namespace lamina

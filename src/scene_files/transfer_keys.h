// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "scene/given_transfer.h"
#include "scene_files/keys.h"

namespace lamina {

// The keys of the object "transfer_function" of scene files and of `lamina integrate`
// (docs/scene.md).
const KeyTable<GivenTransfer>& transfer_keys();

// Reads that object, and closes the reader; colours are of its colour space. Throws KeyError, also
// if the function is not open and there is none of these points and this map.
GivenTransfer read_transfer_function(JsonReader reader);

// Adds "transfer_function" to the scene's keys.
void add_transfer_function(KeyTable<Scene>& scene);

}  // namespace lamina

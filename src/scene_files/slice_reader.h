// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Read "render.slice" and "render.emulate" of a scene file (docs/scene.md).
SliceSettings read_slice(JsonReader reader);
Emulation read_emulation(JsonReader reader);

}  // namespace lamina

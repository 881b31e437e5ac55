// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "scene_files/keys.h"

namespace lamina {

// All keys of scene files (docs/scene.md).
const KeyTable<Scene>& scene_keys();

// The JSON schema of scene files, as docs/scene.schema.json has it.
std::string scene_schema_text();

}  // namespace lamina

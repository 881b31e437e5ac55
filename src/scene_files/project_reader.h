// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/project_settings.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads "render.project" of a scene file (docs/scene.md).
ProjectSettings read_project(JsonReader reader);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/project_settings.h"
#include "scene_files/json_reader.h"

namespace lamina {

// "render.project" of a scene.
ProjectSettings read_project(JsonReader reader);

}  // namespace lamina

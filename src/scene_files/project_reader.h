// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_files/json_reader.h"
#include "scene/project_settings.h"

namespace lamina {

// "render.project" of a scene.
ProjectSettings read_project(JsonReader reader);

}  // namespace lamina

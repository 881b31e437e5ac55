// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lamina/clip.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads "clip" of a scene file (docs/scene.md). Throws KeyError.
Clip read_clip(JsonReader reader);

// The same key, as it is written.
nlohmann::ordered_json clip_json(const Clip& clip);

}  // namespace lamina

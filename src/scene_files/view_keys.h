// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "scene_files/keys.h"

namespace lamina {

// Adds the keys that say how the data are seen: "camera", "clip", "lighting" and "image".
void add_view_keys(KeyTable<Scene>& scene);

const KeyTable<Camera>& camera_keys();

}  // namespace lamina

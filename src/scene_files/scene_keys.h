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

// Adds the keys that say how the data are seen: "camera", "clip", "lighting" and "image"
// (view_keys.cpp).
void add_view_keys(KeyTable<Scene>& scene);
const KeyTable<Camera>& camera_keys();

// The keys of "render": how the picture is made (render_keys.cpp). The data's keys must be read
// before.
const KeyTable<Scene>& render_keys();
// The form of a compositing tree ("$defs/tree"), and of one of its factors.
KeyJson tree_schema();
KeyJson factor_schema();

}  // namespace lamina

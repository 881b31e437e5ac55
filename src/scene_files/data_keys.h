// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "scene_files/keys.h"

namespace lamina {

// Adds the keys that say what is drawn: "volume", "mesh", "scalar" and "nan".
void add_data_keys(KeyTable<Scene>& scene);

// Tells whether the scene has a volume (a mesh), named by a key or given.
bool has_volume(const JsonReader& reader, const Scene& scene);
bool has_mesh(const JsonReader& reader, const Scene& scene);

// The keys of a volume's object beside `path`: array, level, channel, time, spacing, origin; size,
// type, offset and endian of a raw file.
const KeyTable<VolumeRequest>& volume_selection_keys();

// The scene's "volume": the path alone if nothing is selected.
KeyJson volume_selection_json(const std::string& path, const VolumeRequest& selection);

}  // namespace lamina

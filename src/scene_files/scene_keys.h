// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "scene/given_transfer.h"
#include "scene_files/keys.h"

namespace lamina {

// All keys of scene files (docs/scene.md).
void scene_keys(KeyTable<Scene>& keys);

// The JSON schema of scene files, as docs/scene.schema.json has it.
std::string scene_schema_text();

// Adds the keys of how the data are seen: "camera", "clip", "lighting", "image" (view_keys.cpp).
void add_view_keys(KeyTable<Scene>& scene);
void camera_keys(KeyTable<Camera>& keys);

// The keys of "render": how the picture is made (render_keys.cpp), read after those of the data.
void render_keys(KeyTable<Scene>& keys);
KeyJson tree_schema();  // a compositing tree's ("$defs/tree")

// Adds the keys that say what is drawn: "volume", "mesh", "scalar" and "nan".
void add_data_keys(KeyTable<Scene>& scene);

// Tells whether the scene has a volume (a mesh), named by a key or given.
bool has_volume(const JsonReader& reader, const Scene& scene);
bool has_mesh(const JsonReader& reader, const Scene& scene);

// The keys of a volume's object beside `path`, also those of a raw file.
void volume_selection_keys(KeyTable<VolumeRequest>& keys);

// The scene's "volume": the path alone if nothing is selected.
KeyJson volume_selection_json(const std::string& path, const VolumeRequest& selection);

// The keys of "transfer_function" of scene files and of `lamina integrate` (docs/scene.md).
void transfer_keys(KeyTable<GivenTransfer>& keys);

// Adds "transfer_function" to the scene's keys.
void add_transfer_function(KeyTable<Scene>& scene);

// A segment that `lamina integrate` integrates.
struct IntegrationCase {
    TransferFunction transfer_function;
    GivenTransfer given;
    double front = 0, back = 0;  // scalars, up to 1e300
    double length = 0;           // world units, >= 0
};

// Reads {"transfer_function", "sf", "sb", "length"} and closes the reader. Throws KeyError.
IntegrationCase read_integration_case(JsonReader reader);

}  // namespace lamina

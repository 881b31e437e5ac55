// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "scene/given_transfer.h"
#include "scene_files/keys.h"

namespace lamina {

// Adds all keys of scene files (docs/scene.md).
void scene_keys(KeyTable<Scene>& keys);

// Returns the JSON schema of scene files, the text of docs/scene.schema.json.
std::string scene_schema_text();

// Adds the keys of the view: "camera", "clip", "lighting", "image" (view_keys.cpp).
void add_view_keys(KeyTable<Scene>& scene);
void camera_keys(KeyTable<Camera>& keys);
Form<Annotations> annotations_form();  // of "image.annotations" (annotation_keys.cpp)

// Adds the keys of "render" (render_keys.cpp), which are read after those of the data.
void render_keys(KeyTable<Scene>& keys);
KeyJson tree_schema();  // schema of a compositing tree ("$defs/tree")

// Adds the keys that say what is drawn: "volume", "mesh", "scalar" and "nan".
void add_data_keys(KeyTable<Scene>& scene);

// Tell whether the scene has a volume (a mesh), named by a key or given in memory.
bool has_volume(const JsonReader& reader, const Scene& scene);
bool has_mesh(const JsonReader& reader, const Scene& scene);

// Adds the keys that an object "volume" may have beside "path", also those of a raw file.
void volume_selection_keys(KeyTable<VolumeRequest>& keys);

// Returns the value of the key "volume": only the path if nothing is selected.
KeyJson volume_selection_json(const std::string& path, const VolumeRequest& selection);

// Adds the keys of "transfer_function", for scenes and `lamina integrate` (docs/scene.md).
void transfer_keys(KeyTable<GivenTransfer>& keys);

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

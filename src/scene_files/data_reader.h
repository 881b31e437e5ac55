// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "scene_files/json_reader.h"

namespace lamina {

// Reads the keys "volume", "mesh", "scalar" and "nan", which say what is drawn. Throws KeyError.
void read_data(JsonReader& reader, Scene& scene);

}  // namespace lamina

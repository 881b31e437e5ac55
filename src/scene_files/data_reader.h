// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "scene_files/json_reader.h"

namespace lamina {

// The keys "volume", "mesh", "scalar" and "nan": what is drawn. Throws KeyError.
void read_data(JsonReader& reader, Scene& scene);

}  // namespace lamina

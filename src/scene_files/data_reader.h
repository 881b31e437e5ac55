// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "lamina/scene.h"
#include "scene_files/json_reader.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Data in memory, which a scene draws instead of what it names.
struct GivenData {
    enum class Kind { volume, mesh };
    Kind kind = Kind::volume;
    std::function<ValueRange()> range;  // of the finite values
};

// What a scene has to be drawn: named by its keys, or given.
struct PresentData {
    bool volume = false, mesh = false;
};

// Reads the keys "volume", "mesh", "scalar" and "nan", which say what is drawn. `given`: data in
// memory, or null. Throws KeyError.
PresentData read_data(JsonReader& reader, Scene& scene, const GivenData* given = nullptr);

}  // namespace lamina

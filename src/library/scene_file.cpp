// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "lamina/scene.h"
#include "scene_files/scene_reader.h"

namespace lamina {

Scene load_scene(const std::filesystem::path& file) {
    return read_scene(load_json(file), file);
}

}  // namespace lamina

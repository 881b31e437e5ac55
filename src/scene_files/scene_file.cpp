// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "base/client.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "lamina/scene.h"
#include "scene_files/scene_document.h"
#include "scene_files/scene_json.h"
#include "scene_files/scene_reader.h"

namespace lamina {

Scene load_scene(const std::filesystem::path& file, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(scene_document(file), file);
}

void save_scene(const Scene& scene, const std::filesystem::path& file) {
    AtomicFile output(file);
    output.write(json_text(scene_json(scene), 1) + "\n");
    output.commit();
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "lamina/scene.h"

namespace lamina {

// A scene file (docs/scene.md) with every key written out, from which read_scene() makes the same
// scene. Paths are absolute, numbers have all their digits, and the transfer function is given by
// its points, whatever it was made from.
nlohmann::ordered_json scene_json(const Scene& scene);

// Writes that document to a file. Throws Error where it cannot.
void save_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace lamina

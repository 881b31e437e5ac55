// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "lamina/export.h"
#include "lamina/mesh_data.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Reads a scene (docs/scene.md) from text instead of a file. `name` stands for the file: messages
// name it, and relative paths start at its folder. If data in memory are given, the scene need not
// name any: a Session of scene and data draws these. `only_below` means what it means for
// load_volume() (lamina/data_files.h). Throws Error.
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const std::filesystem::path& only_below = {});
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const Volume& data, const std::filesystem::path& only_below = {});
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const MeshData& data, const std::filesystem::path& only_below = {});

// Returns a scene file with every key written out, as save_scene() writes it. Data in memory are
// not in it.
LAMINA_API std::string scene_text(const Scene& scene);

}  // namespace lamina

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
// have it, and relative paths start at its folder. With data in memory the scene need not name any:
// they are what a Session of scene and data draws. `only_below`: as for load_volume() of files
// (lamina/data_files.h). Throws Error.
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const std::filesystem::path& only_below = {});
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const Volume& data, const std::filesystem::path& only_below = {});
LAMINA_API Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                             const MeshData& data, const std::filesystem::path& only_below = {});

// A scene file with every key written out, as save_scene() writes it. Data in memory are not in it.
LAMINA_API std::string scene_text(const Scene& scene);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// The files that reading one file means. A volume's: volume/volume_file.h.
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// A mesh's one or two.
std::vector<std::filesystem::path> files_of_mesh(const std::filesystem::path& mesh);

// The scene's own, and those of all that it names: its volume, its mesh, its colour map.
std::vector<std::filesystem::path> files_of(const Scene& scene);

}  // namespace lamina

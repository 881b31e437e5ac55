// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace lamina {

// All files that a scene file names, or that belong to them: its volume, that one's data file, its
// mesh in one or two files, its colour map.
std::vector<std::filesystem::path> files_of(const Scene& scene);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// Returns the files that a scene is made of: its own, and those that it names: volume, mesh and
// colour map.
std::vector<std::filesystem::path> files_of(const Scene& scene);

}  // namespace lamina

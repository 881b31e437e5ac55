// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// The scene's own, and those of all that it names: its volume, its mesh, its colour map.
std::vector<std::filesystem::path> files_of(const Scene& scene);

}  // namespace lamina

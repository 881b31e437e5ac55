// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/mesh_data.h"
#include "mesh_files/mesh_assembly.h"

namespace lamina {

// The .vtu files that a .pvtu (a mesh as the processes of a parallel program write it) names, in
// its order. Throws Error.
std::vector<std::filesystem::path> pieces_of_pvtu(const std::filesystem::path& path);

// Reads them all and joins them. Throws Error.
MeshData read_pvtu(const std::filesystem::path& path);
void add_pvtu(const std::filesystem::path& path, MeshAssembly& assembly);

}  // namespace lamina

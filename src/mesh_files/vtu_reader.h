// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/mesh_data.h"
#include "mesh_files/mesh_assembly.h"

namespace lamina {

// Reads a VTK XML unstructured grid: ascii, binary or appended (raw, base64) arrays, uncompressed
// or with zlib, of either byte order and header type, in one piece or several. Throws Error.
MeshData read_vtu(const std::filesystem::path& path);
void add_vtu(const std::filesystem::path& path, MeshAssembly& assembly);

}  // namespace lamina

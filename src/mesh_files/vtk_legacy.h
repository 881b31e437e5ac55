// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/mesh_data.h"

namespace lamina {

// Reads a legacy VTK file with an unstructured grid, ASCII or binary, of any version up to 5.1.
// Throws Error.
MeshData read_vtk(const std::filesystem::path& path);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lamina/mesh_data.h"
#include "mesh_files/mesh_assembly.h"

namespace lamina {

// Reads a VTK XML unstructured grid: ascii, binary or appended (raw, base64) arrays, uncompressed
// or with zlib, of either byte order and header type, in one piece or several. Throws Error.
MeshData read_vtu(const std::filesystem::path& path);
void add_vtu(const std::filesystem::path& path, MeshAssembly& assembly);

// Returns the .vtu files that a .pvtu (a mesh as the processes of a parallel program write it)
// names, in its order. Throws Error.
std::vector<std::filesystem::path> pieces_of_pvtu(const std::filesystem::path& path);

// Reads the pieces of a .pvtu and joins them. Throws Error.
MeshData read_pvtu(const std::filesystem::path& path);
void add_pvtu(const std::filesystem::path& path, MeshAssembly& assembly);

// One step of a .pvd file (ParaView's list of the files of a mesh that changes with time).
struct PvdStep {
    double time = 0;
    std::vector<std::filesystem::path> files;  // .vtu or .pvtu, the parts of the mesh
};

// Returns the steps of a .pvd file in the order of their times. Throws Error.
std::vector<PvdStep> steps_of_pvd(const std::filesystem::path& path);

// Reads and joins the files of one step, the first of which is 0. Throws Error, also if there is no
// such step.
MeshData read_pvd(const std::filesystem::path& path, std::int64_t step);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/atomic_file.h"
#include "lamina/mesh_data.h"

namespace lamina {

// Whether a path names a mesh: by its content (VTK's formats), else by its extension: .vtu, .vtk,
// .node or .ele.
bool is_mesh_file(const std::filesystem::path& path);

// Reads a mesh: a VTK XML or legacy VTK unstructured grid, or TetGen's pair of .node and .ele
// (either name stands for both). Hexahedra, voxels, wedges and pyramids are cut into tets
// (mesh_files/cell_split.h); cells without volume are counted. Point and cell arrays of one
// component become scalars, and those of three components become the lengths of their vectors.
// Other arrays are skipped. All corner indices of the result are in range. Throws Error: one line
// that names the file, what was found and what was expected. Takes no memory for data that the file
// cannot hold.
MeshData read_mesh(const std::filesystem::path& path);

// Writes a VTK XML unstructured grid. All numbers are Float64, appended raw with zlib, in this
// machine's byte order. Throws Error where it cannot be written. Does not commit the file.
void write_vtu(AtomicFile& file, const MeshData& mesh);

// Write TetGen's pair of files, counted from 1, with 17 digits. Point scalars become point
// attributes and cell scalars become attributes of the tets. Their names stand in comments
// (mesh_files/node_ele.h).
void write_node(AtomicFile& file, const MeshData& mesh);
void write_ele(AtomicFile& file, const MeshData& mesh);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/atomic_file.h"
#include "lamina/mesh_data.h"

namespace lamina {

// By the extension: .vtu, .vtk, .node or .ele.
bool is_mesh_file(const std::filesystem::path& path);

// Reads a mesh: a VTK XML or legacy VTK unstructured grid, or TetGen's pair of .node and .ele
// (either names both). Hexahedra, voxels, wedges and pyramids become tets
// (mesh_files/cell_split.h), cells without volume are counted. Point and cell arrays of one
// component become scalars, those of three the lengths of their vectors; others are passed over.
// All corner indices are in range. Throws Error: one line that names the file, what was found and
// what was expected; takes no memory for what the file cannot hold.
MeshData read_mesh(const std::filesystem::path& path);

// A VTK XML unstructured grid: all numbers Float64, appended raw with zlib, in this machine's byte
// order. Throws Error when it cannot be written; does not commit.
void write_vtu(AtomicFile& file, const MeshData& mesh);

// TetGen's pair, counted from 1, 17 digits; point scalars as point attributes, cell scalars as
// attributes of the tets, their names in comments (see mesh_files/node_ele.h).
void write_node(AtomicFile& file, const MeshData& mesh);
void write_ele(AtomicFile& file, const MeshData& mesh);

}  // namespace lamina

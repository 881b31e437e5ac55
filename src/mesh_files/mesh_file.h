// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/output_file.h"
#include "lamina/mesh.h"

namespace lamina {

// Tells if a path names a mesh: by its content (VTK's formats), else by its extension.
bool is_mesh_file(const std::filesystem::path& path);

// Reads a mesh from a VTK XML or legacy VTK unstructured grid, a .pvtu that names several files,
// one step of a .pvd, or TetGen's pair of .node and .ele (either name stands for both). Pieces are
// joined, cells cut into tets and arrays made scalars as mesh_files/mesh_assembly.h says; cells
// without volume are counted. All corner indices are in range. `time`: index of the step in the
// order of time, from 0; only a .pvd has several. `join`: points at most so far from an earlier one
// take its place (NearPlaces in mesh/point_table.h); a warning counts them. Throws Error.
MeshData read_mesh(const std::filesystem::path& path, std::int64_t time = 0, double join = 0);

// Throws Error, which says what to do, if a file is of a kind of mesh that is not read: by its
// content (VTK XML, Gmsh, XDMF), else by its extension.
void expect_no_foreign_mesh(const std::filesystem::path& path);

// The extensions of mesh files, for messages.
inline constexpr const char* mesh_format_list = ".vtu, .pvtu, .pvd, .vtk, .node, .ele";

// Returns the number of steps of a mesh file: 1, except of a .pvd. Throws Error.
std::int64_t steps_of_mesh(const std::filesystem::path& path);
// Returns the times of the steps of a .pvd, in their order; none for other files. Throws Error.
std::vector<double> times_of_mesh(const std::filesystem::path& path);

// Returns the files that hold the mesh, with all its steps: `path` first. Throws Error.
std::vector<std::filesystem::path> files_of_mesh(const std::filesystem::path& path);

// Writes a VTK XML unstructured grid. All numbers are Float64, appended raw with zlib, in this
// machine's byte order. Does not commit the file. Throws Error.
void write_vtu(AtomicFile& file, const MeshData& mesh);

// Write TetGen's pair of files, counted from 1, with 17 digits. Scalars of points and cells become
// attributes of points and tets; comments hold their names (mesh_files/mesh_formats.h).
void write_node(AtomicFile& file, const MeshData& mesh);
void write_ele(AtomicFile& file, const MeshData& mesh);

}  // namespace lamina

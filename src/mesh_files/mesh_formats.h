// SPDX-License-Identifier: Apache-2.0
// The readers of mesh files, for read_mesh(), which says what `join` is. All throw Error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lamina/mesh.h"

namespace lamina {

// Reads a VTK XML unstructured grid: ascii, binary or appended (raw, base64) arrays, uncompressed
// or compressed, of either byte order and header type, in one piece or several.
MeshData read_vtu(const std::filesystem::path& path, double join);

// Returns the .vtu files that a .pvtu (a parallel program's mesh) names, in its order.
std::vector<std::filesystem::path> pieces_of_pvtu(const std::filesystem::path& path);

MeshData read_pvtu(const std::filesystem::path& path, double join);

// One step of a .pvd file (ParaView's list of the files of a mesh that changes with time).
struct PvdStep {
    double time = 0;
    std::vector<std::filesystem::path> files;  // .vtu or .pvtu, the pieces of the mesh
};

// Returns the steps of a .pvd file in the order of their times.
std::vector<PvdStep> steps_of_pvd(const std::filesystem::path& path);

// Reads and joins the files of one step, the first of which is 0.
MeshData read_pvd(const std::filesystem::path& path, std::int64_t step, double join);

// Reads a legacy VTK file with an unstructured grid, ASCII or binary, of any version up to 5.1.
MeshData read_vtk(const std::filesystem::path& path, double join);

// Reads TetGen's NAME.node and NAME.ele; `path` is one of them. Points count from 0 or from 1, as
// the first point says. Tets may have 10 nodes, and boundary markers are ignored. Attribute N gives
// a scalar of the points or tets, "point attribute N", unless a comment before the numbers names
// it, as in lamina's own files: "# point attribute N: NAME".
MeshData read_node_ele(const std::filesystem::path& path, double join);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lamina/mesh.h"
#include "mesh/point_table.h"
#include "mesh_files/cell_cuts.h"

namespace lamina {

// Cells in the form of VTK's unstructured grids: cell i has the type types[i] and the points
// connectivity[ends[i - 1]] ... connectivity[ends[i] - 1].
struct MeshCells {
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> ends;
    std::vector<std::int64_t> types;
    // Face streams of polyhedra: that of cell i ends at face_ends[i], which is -1 if it is none. No
    // face_ends: a polyhedron's stream stands in place of its points.
    std::vector<std::int64_t> faces, face_ends;
};

// One unstructured grid of a file, or one piece of it.
struct MeshPiece {
    std::string label;  // "FILE" or "FILE: Piece 2", for messages
    std::vector<glm::dvec3> points;
    MeshCells cells;
    std::vector<MeshScalar> point_scalars;
    std::vector<MeshScalar> cell_scalars;  // one value a cell
    bool old_hexahedra = false;            // see CellLattice::old_numbers
    std::vector<double> orders;            // of Lagrange cells, three a cell; empty: not told
};

std::vector<glm::dvec3> points_from_values(const std::vector<double>& values);

// Tells if an array gives scalars: one component is a scalar; three give the vector's length, under
// the array's name, and the components, under its name with .x, .y and .z. Others give none.
inline bool makes_scalar(std::int64_t components) {
    return components == 1 || components == 3;
}
void add_scalars(std::vector<MeshScalar>& scalars, const std::string& name, std::int64_t components,
                 std::vector<double> values);

// Bits of vtkGhostType that hide (vtkDataSetAttributes.h). Points: HIDDENPOINT. Cells:
// DUPLICATECELL, which another piece draws, REFINEDCELL and HIDDENCELL. Points that another piece
// also has (DUPLICATEPOINT) have values like others, and hide nothing.
inline constexpr int vtk_hidden_point = 2, vtk_hidden_cell = 1 | 8 | 32;

// Joins pieces into one mesh. Points of two pieces at exactly one place become one if they have
// equal values (unless a piece has several there); others stay copies (mesh/tet_mesh.h). Cells are
// cut into tets by the places of all points, so that faces between pieces, and between cells that
// share no points, conform. Cells that an array "vtkGhostType" or "vtkGhostLevels" marks as hidden
// or another piece's, and those with a hidden point, are left out. Throws Error if a cell is
// invalid.
class MeshAssembly {
  public:
    // `join`: for read_mesh().
    MeshAssembly(std::string file, double join) : file_(std::move(file)), near_(join) {}
    MeshAssembly(const MeshAssembly&) = delete;
    MeshAssembly& operator=(const MeshAssembly&) = delete;

    void add(MeshPiece piece);
    MeshData finish();  // throws Error if there is no point or no tet

  private:
    std::vector<std::int32_t> add_points(const MeshPiece& piece,
                                         std::span<const MeshScalar* const> scalars);
    std::vector<std::int64_t> add_cells(const MeshPiece& piece, const std::vector<bool>& ghosts,
                                        std::span<const std::int32_t> indices);
    void number_cells(const std::vector<std::int64_t>& cell_of_tet);

    std::string file_;
    NearPlaces near_;
    MeshData mesh_;
    PointPlaces places_{mesh_.points};  // known once there are several pieces, or cells to cut
    CellCuts cuts_{mesh_, places_};
    std::int64_t cells_ = 0;  // with volume
    bool first_ = true;
};

}  // namespace lamina

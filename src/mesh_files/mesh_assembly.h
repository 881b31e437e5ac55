// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lamina/mesh_data.h"
#include "mesh_files/point_table.h"

namespace lamina {

// Cells in the form of VTK's unstructured grids: cell i has the type types[i] and the points
// connectivity[ends[i - 1]] ... connectivity[ends[i] - 1].
struct MeshCells {
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> ends;
    std::vector<std::int64_t> types;
};

// One unstructured grid of a file, or one piece of it.
struct MeshPiece {
    std::string label;  // "FILE" or "FILE: Piece 2", for messages
    std::vector<glm::dvec3> points;
    MeshCells cells;
    std::vector<MeshScalar> point_scalars;
    std::vector<MeshScalar> cell_scalars;  // one value a cell
};

std::vector<glm::dvec3> points_from_values(const std::vector<double>& values);

// Whether an array gives scalars: with one component the array itself; with three components the
// length of the vector, under its name, then the components, under its name with .x, .y and .z.
// Other arrays give none.
inline bool makes_scalar(std::int64_t components) {
    return components == 1 || components == 3;
}
void add_scalars(std::vector<MeshScalar>& scalars, const std::string& name, std::int64_t components,
                 std::vector<double> values);

// Joins pieces into one mesh. A point at exactly the place of a point of another piece is that
// point (where each piece has one there), so that the mesh goes on from piece to piece. Cells are
// cut into tets by the indices of all points, so that faces between pieces conform; cells that an
// array "vtkGhostType" or "vtkGhostLevels" marks as another piece's are left out. Throws Error for
// invalid cells.
class MeshAssembly {
  public:
    explicit MeshAssembly(std::string file) : file_(std::move(file)) {}
    MeshAssembly(const MeshAssembly&) = delete;
    MeshAssembly& operator=(const MeshAssembly&) = delete;

    void add(MeshPiece piece);
    MeshData finish();  // throws Error where there is no point or no tet

  private:
    std::vector<std::int32_t> add_points(const MeshPiece& piece);
    std::vector<std::int64_t> add_cells(const MeshPiece& piece, const std::vector<bool>& ghosts,
                                        std::span<const std::int32_t> indices);
    void add_point_scalars(MeshPiece& piece, std::size_t points_before,
                           std::span<const std::int32_t> indices);

    std::string file_;
    MeshData mesh_;
    std::optional<PointTable> table_;  // of mesh_.points, once there are several pieces
    bool first_ = true;
};

}  // namespace lamina

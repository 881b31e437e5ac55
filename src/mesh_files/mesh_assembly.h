// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lamina/mesh.h"

namespace lamina {

// How readers treat cells of a VTK type (vtkCellType.h); skip: the cell has no volume.
enum class CellUse { skip, tet, split, unsupported };
CellUse use_of_cell(std::int64_t type);

// The tets that one cell is cut into.
struct SplitCell {
    std::array<Tet, 6> tets;
    std::size_t count = 0;
};

// Cuts a hexahedron, voxel, wedge or pyramid into 6, 6, 3 or 2 tets (like Dompierre, Labbe, Vallet,
// Camarero, How to subdivide pyramids, prisms and hexahedra into tetrahedra, 1999, whose hexahedra
// sometimes have only five). Each quadrilateral face is cut along the diagonal through its least
// point index, so that neighbouring cells agree; then the cell's least point is joined to the
// triangles of the faces without it. Wedges may have either orientation. Other inverted cells give
// inverted tets, and repeated corners repeated ones. `type`: a VTK type with straight edges.
// `corners`: valid indices of `points`.
SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points);

// Finds points by their exact coordinates (0 equals -0; a point with NaN is never found). If
// several points lie at one place, as on both sides of a crack, none is found there.
class PointTable {
  public:
    // `points`: the points by index. The vector may grow, and must outlive this table.
    explicit PointTable(const std::vector<glm::dvec3>& points) : points_(points) {}

    void add(std::int32_t point);
    void add_all();  // all points that there are now
    // Returns the index of the only added point at this place, or -1.
    std::int32_t find(const glm::dvec3& place) const;

  private:
    std::size_t slot_of(const glm::dvec3& place) const;
    void grow(std::size_t slots);

    const std::vector<glm::dvec3>& points_;
    // A hash table with linear probing: its size is a power of two, at most half full. An entry is
    // 0 (empty), i + 1 (the point i), or -(i + 1) (several points, the first of which is i).
    std::vector<std::int32_t> slots_;
    std::size_t used_ = 0;  // entries that are not empty
};

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

// Tells if an array gives scalars: one component is a scalar; three give the vector's length, under
// the array's name, and the components, under its name with .x, .y and .z. Others give none.
inline bool makes_scalar(std::int64_t components) {
    return components == 1 || components == 3;
}
void add_scalars(std::vector<MeshScalar>& scalars, const std::string& name, std::int64_t components,
                 std::vector<double> values);

// Joins pieces into one mesh. Points of two pieces at exactly one place become one (unless a piece
// has several there). Cells are cut into tets by the indices of all points, so that faces between
// pieces conform. Cells that an array "vtkGhostType" or "vtkGhostLevels" marks as another piece's
// are left out. Throws Error if a cell is invalid.
class MeshAssembly {
  public:
    explicit MeshAssembly(std::string file) : file_(std::move(file)) {}
    MeshAssembly(const MeshAssembly&) = delete;
    MeshAssembly& operator=(const MeshAssembly&) = delete;

    void add(MeshPiece piece);
    MeshData finish();  // throws Error if there is no point or no tet

  private:
    std::vector<std::int32_t> add_points(const MeshPiece& piece);
    std::vector<std::int64_t> add_cells(const MeshPiece& piece, const std::vector<bool>& ghosts,
                                        std::span<const std::int32_t> indices);
    void add_point_scalars(MeshPiece& piece, std::size_t points_before,
                           std::span<const std::int32_t> indices);

    std::string file_;
    MeshData mesh_;
    std::optional<PointTable> table_;  // finds mesh_.points, once there are several pieces
    bool first_ = true;
};

}  // namespace lamina

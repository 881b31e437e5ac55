// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "lamina/tet.h"

namespace lamina {

// What to do with cells of a VTK type (the numbers of vtkCellType.h).
enum class CellUse { skip, tet, split, unsupported };  // skip: no volume
CellUse use_of_cell(std::int64_t type);

// How many points a cell of a type with volume has (10 for a quadratic tetrahedron, the first four
// of which are its corners), and the name of the type for messages.
struct CellType {
    const char* name;
    std::size_t points;
};
CellType cell_type(std::int64_t type);

// The tets of one cell.
struct SplitCell {
    std::array<Tet, 6> tets;
    std::size_t count = 0;
};

// Cuts a hexahedron, voxel, wedge or pyramid into 6, 6, 3 or 2 tets: each quadrilateral face by the
// diagonal through its least point index (Dompierre, Labbe, Vallet, Camarero, How to subdivide
// pyramids, prisms and hexahedra into tetrahedra, 1999), so that neighbours agree wherever they
// come from, and the inside by joining the cell's least point to the triangles of the faces without
// it. (Where none of the paper's diagonals meets the corner opposite that point the paper has five
// tets; the sixth here leaves the faces as they are.) A wedge may be numbered in either sense: both
// are in use. Other cells are cut as they are, so that an inverted one gives inverted tets.
// `corners` must be valid indices of `points`; a repeated one gives tets with a repeated corner.
SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points);

}  // namespace lamina

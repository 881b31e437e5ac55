// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "lamina/tet.h"

namespace lamina {

// How readers treat cells of a VTK type (the numbers of vtkCellType.h); skip: the cell has no
// volume.
enum class CellUse { skip, tet, split, unsupported };
CellUse use_of_cell(std::int64_t type);

// Most points of a cell type that is read: those of a triquadratic hexahedron.
inline constexpr std::size_t most_cell_points = 27;

// A type of cell with volume. Only the corners of a quadratic cell are used, which come first: it
// is straightened to the cell of type `straight`.
struct CellType {
    const char* name;     // for messages
    std::size_t points;   // in the file
    std::size_t corners;  // the first of these
    std::int64_t straight;
};
CellType cell_type(std::int64_t type);

// The tets that one cell is cut into.
struct SplitCell {
    std::array<Tet, 6> tets;
    std::size_t count = 0;
};

// Cuts a hexahedron, voxel, wedge or pyramid into 6, 6, 3 or 2 tets. Each quadrilateral face is cut
// along the diagonal through its least point index, so that neighbouring cells agree whatever file
// they come from (Dompierre, Labbe, Vallet, Camarero, How to subdivide pyramids, prisms and
// hexahedra into tetrahedra, 1999). The inside is cut by joining the cell's least point to the
// triangles of the faces without it. The paper has five tets if none of its diagonals meets the
// corner opposite that point; the sixth tet here leaves the faces as they are. A wedge may be
// numbered in either sense, because both are in use. Other cells are cut as numbered, so that an
// inverted cell gives inverted tets, and a repeated corner gives tets with a repeated corner.
// `type`: one with straight edges. `corners`: valid indices of `points`.
SplitCell split_cell(std::int64_t type, std::span<const std::int32_t> corners,
                     std::span<const glm::dvec3> points);

}  // namespace lamina

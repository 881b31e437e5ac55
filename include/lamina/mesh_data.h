// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "lamina/tet.h"

namespace lamina {

struct MeshScalar {
    std::string name;
    std::vector<double> values;  // one for each point, or one for each tet
};

// How many cells and points of a file were changed or left out.
struct CellCounts {
    std::int64_t split = 0;          // hexahedra, wedges and pyramids that were cut into tets
    std::int64_t skipped = 0;        // vertices, lines, polygons: no volume
    std::int64_t straightened = 0;   // quadratic cells, of which only the corners are used
    std::int64_t ghosts = 0;         // cells that another piece of the mesh has, too: left out
    std::int64_t merged_points = 0;  // points that another piece of the mesh has, too
};

// A tetrahedral mesh as a file or a generator gives it: nothing is checked or repaired. TetMesh
// (mesh/tet_mesh.h) is made from it, and mesh files are written from it.
struct MeshData {
    std::vector<glm::dvec3> points;  // world
    std::vector<Tet> tets;           // in the file's order and orientation
    std::vector<MeshScalar> point_scalars;
    std::vector<MeshScalar> cell_scalars;
    CellCounts cells;
};

}  // namespace lamina

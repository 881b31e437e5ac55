// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/tet.h"

namespace lamina {

struct MeshScalar {
    std::string name;
    std::vector<double> values;  // one a point, or one a tet
};

// A tetrahedral mesh as a file or a generator gives it, nothing checked or repaired: what
// mesh/tet_mesh.h starts from and what mesh files are written from.
struct MeshData {
    std::vector<glm::dvec3> points;  // world
    std::vector<Tet> tets;           // in the file's order and orientation
    std::vector<MeshScalar> point_scalars;
    std::vector<MeshScalar> cell_scalars;
    std::int64_t split_cells = 0;    // hexahedra, wedges and pyramids that were cut into tets
    std::int64_t skipped_cells = 0;  // vertices, lines, polygons: no volume
};

}  // namespace lamina

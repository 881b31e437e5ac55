// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "mesh/tet_mesh.h"

namespace lamina {

// Counts the tets at whose open faces the mesh overlaps itself: faces that other open faces cross,
// folded faces and nonmanifold ones, and parts that lie inside others. Their tets share space, so
// no order of them is right. Exact for faces that cross, except where that would take too long, as
// among thousands of needles whose boxes all overlap: then some may be missed. Touching is no
// overlap. Parts inside others count one tet each; of more than 500 parts some are looked at.
// Parallel.
std::int64_t count_overlapping_tets(const TetMesh& mesh);

}  // namespace lamina

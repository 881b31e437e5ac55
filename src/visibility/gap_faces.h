// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/tet_mesh.h"

namespace lamina {

// The open faces at which gaps of a mesh may begin or end as seen from some eye, in ascending
// order: indices into TetMesh::open_faces(). Left out are those with no other part of the mesh
// outside of them, or against them from there: a ray that leaves the mesh through such a face does
// not come back, and one that enters by it has not met the mesh before. Exact; where that takes too
// long, as on finely faceted surfaces that are flat but for rounding, some others are in it.
std::vector<std::int32_t> gap_faces(const TetMesh& mesh);

}  // namespace lamina

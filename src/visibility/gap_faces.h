// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/tet_mesh.h"

namespace lamina {

// Finds the open faces at which gaps of a mesh may begin or end as seen from some eye. Returns
// indices into TetMesh::open_faces() in ascending order. A face is left out where no other part of
// the mesh lies outside of it or touches it from there: a ray that leaves the mesh through such a
// face does not come back, and a ray that enters by it has not met the mesh before. The result is
// exact, except where that would take too long, as on finely faceted surfaces that are flat up to
// rounding. There it contains some other faces, too.
std::vector<std::int32_t> gap_faces(const TetMesh& mesh);

}  // namespace lamina

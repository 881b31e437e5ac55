// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/mesh_data.h"
#include "meshing/trilinear_field.h"

namespace lamina {

// The name of the scalar of meshes made from volumes.
inline constexpr const char* mesh_scalar_name = "scalar";

std::int64_t kuhn_tet_count(const TrilinearField& field);

// Cuts each cell between the field's planes into six tets around its diagonal from the lowest to
// the highest corner (Kuhn 1960, Freudenthal 1942). The mesh is conforming, because every face is
// cut along the diagonal from its lowest to its highest corner. Points lie at all crossings of
// planes, x fastest, in index space. Throws Error where there would be more than `max_tets` tets or
// 2^31 points. Parallel.
MeshData make_kuhn_mesh(const TrilinearField& field, std::int64_t max_tets);

}  // namespace lamina

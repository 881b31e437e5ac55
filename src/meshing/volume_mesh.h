// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lamina/mesh_data.h"
#include "lamina/mesh_settings.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "meshing/trilinear_field.h"

namespace lamina {

// The name of the scalar of meshes made from volumes.
inline constexpr const char* mesh_scalar_name = "scalar";

std::int64_t kuhn_tet_count(const TrilinearField& field);

// Cuts each cell between the field's planes into six tets around its diagonal from the lowest to
// the highest corner (Kuhn 1960, Freudenthal 1942). The mesh is conforming, because every face is
// cut along the diagonal from its lowest to its highest corner. Points lie at all crossings of
// planes, x fastest, in index space. Throws Error if there would be more than `max_tets` tets or
// 2^31 points. Parallel.
MeshData make_kuhn_mesh(const TrilinearField& field, std::int64_t max_tets);

// Transforms a mesh from a grid's index space to world space. If the grid is mirrored, the tets are
// reoriented.
void place_in_world(MeshData& mesh, const Grid& grid);

// Makes a mesh of the volume's box with the volume's values at its points (one scalar, "scalar"):
// the Kuhn split or the adaptive mesh. `transfer_function`: regions in which it shows nothing may
// stay coarse; if it is null, everything counts. `report.error` is measured for both kinds. Throws
// Error for samples that are not finite, for a Kuhn split with more than max_tets tets, and if
// lamina-tetrahedralize is missing or fails.
MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh_data.h"
#include "lamina/mesh_settings.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"

namespace lamina {

// Transforms a mesh from a grid's index space to world space. Where the grid is mirrored, the tets
// are reoriented.
void place_in_world(MeshData& mesh, const Grid& grid);

// Makes a mesh of the volume's box with the volume's values at its points (one scalar, "scalar"):
// the Kuhn split or the adaptive mesh. `transfer_function`: regions in which it shows nothing may
// stay coarse; with null everything counts. `report.error` is measured for both kinds. Throws Error
// for samples that are not finite, for a Kuhn split with more than max_tets tets, and where
// lamina-tetrahedralize is missing or fails.
MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report);

}  // namespace lamina

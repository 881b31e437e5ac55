// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh_data.h"
#include "lamina/mesh_settings.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"

namespace lamina {

// Moves a mesh from a grid's index space into the world; turns its tets where the grid is mirrored.
void place_in_world(MeshData& mesh, const Grid& grid);

// A mesh of the volume's box with the volume's values at its points (one scalar, "scalar"): the
// Kuhn split or the adaptive mesh. `transfer_function`: what it shows nothing of may stay coarse;
// null: everything counts. `report.error` is measured for both kinds. Throws Error: samples that
// are no finite numbers, a Kuhn split with more than max_tets tets, lamina-tetrahedralize missing
// or failing.
MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report);

}  // namespace lamina

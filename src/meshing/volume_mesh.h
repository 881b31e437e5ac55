// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh.h"
#include "meshing/delaunay.h"
#include "meshing/interpolation_error.h"

namespace lamina {

inline constexpr const char* mesh_scalar_name = "scalar";

// Cuts each cell into six tets around its diagonal from the lowest to the highest corner (Kuhn
// 1960, Freudenthal 1942). Points lie at all crossings of planes, x fastest, in index space. Throws
// Error for more than `max_tets` tets or 2^31 points. Parallel.
MeshData make_kuhn_mesh(const TrilinearField& field, std::int64_t max_tets);

// Makes a Delaunay mesh of the field's box. Each round adds points where tets are farthest from the
// field (Garland and Heckbert, Fast polygonal approximation of terrains and height fields, 1995),
// until all are within the tolerance or another round would exceed max_tets.
//
// Points are in index space, where the box is exactly a box, on a lattice of 1/256 of a sample:
// tets are exactly flat or clearly not. The result is the same every time. Throws Error.
MeshData make_adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                            const Delaunay& delaunay, const MeshSettings& settings,
                            MeshReport& report);

void place_in_world(MeshData& mesh, const Grid& grid);

// Makes the Kuhn split or the adaptive mesh. `transfer_function`: regions in which it shows nothing
// may stay coarse; null: everything counts. Throws Error for samples that are not finite, more than
// max_tets tets of a Kuhn split, and if lamina-tetrahedralize is missing or fails.
MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh.h"
#include "meshing/delaunay.h"
#include "meshing/interpolation_error.h"

namespace lamina {

inline constexpr const char* mesh_scalar_name = "scalar";

// Makes the Kuhn mesh: cuts each cell into six tets around its diagonal from the lowest to the
// highest corner (Kuhn 1960, Freudenthal 1942). Points lie at all crossings of planes, x fastest,
// in index space. Throws Error for more than `max_tets` tets or 2^31 points. Parallel.
MeshData make_kuhn_mesh(const TrilinearField& field, std::int64_t max_tets);

// Makes a Delaunay mesh of the field's box. Each round adds points where tets differ most from the
// field (Garland and Heckbert, Fast polygonal approximation of terrains and height fields, 1995),
// until all tets are within the tolerance or another round would exceed max_tets. Points are in
// index space, where the box's sides are exactly planes, on a lattice with spacing 1/256 sample, so
// tets are exactly flat or clearly not. The result is the same every time. Throws Error.
MeshData make_adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                            const Delaunay& delaunay, const MeshSettings& settings,
                            MeshReport& report);

// Converts the points from index space to world space, and keeps tets positive.
void place_in_world(MeshData& mesh, const Grid& grid);

// Makes the Kuhn or the adaptive mesh of a volume, in world space. The mesh may stay coarse where
// `transfer_function` shows nothing; if it is null, everything counts. Throws Error for samples
// that are not finite, Kuhn meshes above max_tets, and without lamina-tetrahedralize.
MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh_data.h"
#include "lamina/mesh_settings.h"
#include "meshing/delaunay.h"
#include "meshing/interpolation_error.h"
#include "meshing/trilinear_field.h"

namespace lamina {

// A Delaunay mesh of the field's box with points where they are needed: from the box's corners on,
// each round adds a point where a tet is farthest from the field (Garland and Heckbert, Fast
// polygonal approximation of terrains and height fields, 1995, in three dimensions), until all tets
// are within the tolerance, or another round would pass max_tets.
//
// Delaunay in index space: there the box is exactly a box, whatever the grid's spacing and
// rotation, and the distance between samples, which is the scale of the field's details, is the
// same along all axes. Points lie on a lattice of 1/256 of a sample: tets are then flat exactly or
// not nearly, and no two points nearly coincide.
//
// Points in index space. The same result every time. Throws Error.
MeshData make_adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                            const Delaunay& delaunay, const MeshSettings& settings,
                            MeshReport& report);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh_data.h"
#include "lamina/mesh_settings.h"
#include "meshing/delaunay.h"
#include "meshing/interpolation_error.h"
#include "meshing/trilinear_field.h"

namespace lamina {

// Makes a Delaunay mesh of the field's box with points where the field needs them. It starts from
// the box's corners. Each round adds points at the places where tets are farthest from the field,
// as Garland and Heckbert do for terrains (Fast polygonal approximation of terrains and height
// fields, 1995). It ends when all tets are within the tolerance, or when another round would exceed
// max_tets.
//
// The mesh is Delaunay in index space. There the box is exactly a box for any spacing and rotation
// of the grid, and the distance between samples, which is the scale of the field's details, is the
// same along all axes. Points lie on a lattice of 1/256 of a sample. So tets are either exactly
// flat or clearly not flat, and no two points nearly coincide.
//
// Returns points in index space. The result is the same every time. Throws Error.
MeshData make_adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                            const Delaunay& delaunay, const MeshSettings& settings,
                            MeshReport& report);

}  // namespace lamina

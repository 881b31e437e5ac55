// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "lamina/mesh_data.h"
#include "lamina/tet.h"

namespace lamina {

// Converts cell data to point data. At each point it takes the mean over the tets around it, all
// with the same weight, as vtkCellDataToPointData does (a hexahedron that was cut counts once for
// each tet). Weights by volume would keep the field's integral but favour the larger side: between
// cells of lengths h < H with the centre values of a linear field they miss the value in the middle
// by slope * (H - h) / 2, the plain mean by half of that. A NaN reaches all points of its tet.
// Points without tets get the first finite value of all tets, so that ranges and counts do not
// change; nothing draws these points. `tets` must have indices < point_count, and `scalar` one
// value a tet.
MeshScalar average_to_points(std::size_t point_count, std::span<const Tet> tets,
                             const MeshScalar& scalar);

}  // namespace lamina

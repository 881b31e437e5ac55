// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "lamina/mesh_data.h"
#include "lamina/tet.h"

namespace lamina {

// Cell data as point data: at each point the mean over the tets around it, each with the same
// weight, as vtkCellDataToPointData has it (a hexahedron that was cut counts once a tet). (Weights
// by volume would keep the field's integral, but lean towards the larger side: between cells of
// lengths h < H that hold a linear field's centre values they miss the value in the middle by slope
// * (H - h) / 2, the plain mean by half of that.) A NaN reaches all points of its tet. Points
// without tets get the first finite value of all tets: nothing draws them, and ranges and counts
// stay what they are. `tets` must have indices < point_count only, and `scalar` one value a tet.
MeshScalar average_to_points(std::size_t point_count, std::span<const Tet> tets,
                             const MeshScalar& scalar);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "facts/index_plane.h"
#include "lamina/grid.h"
#include "scene/camera.h"
#include "slicing/slab_polygons.h"

namespace lamina {

// Where the viewing rays are with respect to a plane of the clip: the distance of a ray's origin,
// where the nearest slab begins, and the distance's change with depth. Both are linear in the
// pixel, counted from the image's middle to the right and downwards.
struct RayPlane {
    double origin_middle = 0, origin_column = 0, origin_row = 0;
    double slope_middle = 0, slope_column = 0, slope_row = 0;
};

// Grid, view and slabs in the same units of length.
std::vector<RayPlane> ray_planes(const std::vector<IndexPlane>& clip, const Grid& grid,
                                 const View& view, const Slabs& slabs);

}  // namespace lamina

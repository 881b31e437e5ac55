// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Counts for each pixel the bricks that its ray may cross and in which the scalar passes a point of
// the transfer function. A feature that is narrower than a slab lies in such a brick. A brick
// counts in all pixels of its bounding rectangle in the picture. If there are very many such
// bricks, only one of several is counted.
std::vector<float> cover_of_points(const MinMaxBricks& bricks, const Grid& grid,
                                   const TransferFunction& transfer_function, const View& view);

}  // namespace lamina

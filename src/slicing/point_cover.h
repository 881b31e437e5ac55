// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// For each pixel, how many bricks its ray may cross in which the scalar passes a point of the
// transfer function: a feature that is narrower than a slab lies in such a brick. A brick counts in
// the rectangle around it in the picture. Where there are very many such bricks, one of several is
// counted.
std::vector<float> cover_of_points(const MinMaxBricks& bricks, const Grid& grid,
                                   const TransferFunction& transfer_function, const View& view);

}  // namespace lamina

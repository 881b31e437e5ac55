// SPDX-License-Identifier: Apache-2.0
// Samples here and there, far from each other: of a volume that stays in its files they are read
// alone, so that no bricks are read for the sake of a few samples.
#pragma once

#include <array>
#include <cstdint>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// At the corners of a cell, x fastest; `upper`: at most one more than `lower`. `bricks`: of the
// volume, or null. Cells of bricks with one value are not read.
std::array<double, 8> scattered_corners(const Volume& volume, const MinMaxBricks* bricks,
                                        const std::array<std::int64_t, 3>& lower,
                                        const std::array<std::int64_t, 3>& upper);

double scattered_sample(const Volume& volume, const std::array<std::int64_t, 3>& place);

}  // namespace lamina

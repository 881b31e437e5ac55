// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "lamina/grid.h"

namespace lamina {

// A grid of which no more is known: samples 1 apart from 0 on, each a node; an axis of one sample
// is a cell.
inline Grid plain_grid(const std::array<std::int64_t, 3>& size) {
    Grid grid;
    grid.size = size;
    for (std::size_t axis = 0; axis < 3; ++axis)
        grid.centering[axis] = size[axis] == 1 ? Centering::cell : Centering::node;
    return grid;
}

}  // namespace lamina

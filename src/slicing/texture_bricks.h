// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "scene/camera.h"
#include "scene/plan.h"
#include "volume/grid.h"

namespace lamina {

// The brick's part of the volume's box: its samples, and at the volume's own border what lies
// beyond them.
IndexBox box_of(const TextureBrick& brick, const Grid& grid);

// Sets the numbers of the bricks of plan.bricks, so that along every ray they come in the plan's
// order. Takes memory only where `numbers` does not yet hold so many.
void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers);

}  // namespace lamina

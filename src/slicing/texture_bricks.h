// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lamina/grid.h"
#include "plan/plan.h"
#include "scene/camera.h"

namespace lamina {

// The brick's part of the volume's box: its samples, and at the volume's own border what lies
// beyond them.
IndexBox box_of(const TextureBrick& brick, const Grid& grid);

// Of a row of a brick along x: places begin .. end - 1 hold the volume's own samples, from number
// `first` on; those beyond repeat the nearest of these.
struct BrickRow {
    std::size_t first;
    std::int64_t begin, end;

    template <typename Texel>
    void repeat_ends(Texel* row, std::int64_t size) const {
        std::fill(row, row + begin, row[begin]);
        std::fill(row + end, row + size, row[end - 1]);
    }
};
BrickRow row_of(const TextureBrick& brick, const Grid& grid, std::int64_t y, std::int64_t z);

// Sets the numbers of the bricks of plan.bricks, so that along every ray they come in the plan's
// order. Takes memory only where `numbers` does not yet hold so many.
void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers);

}  // namespace lamina

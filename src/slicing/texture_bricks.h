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

// The box of index space that a brick draws: that of its samples and, at the volume's border, what
// lies beyond them.
IndexBox box_of(const TextureBrick& brick, const Grid& grid);

// A row of a brick along x. Places begin .. end - 1 hold the volume's own samples, from number
// `first` on. Other places repeat the nearest of these.
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

// Sorts the indices of `bricks` so that along every ray the bricks come in the plan's order. It
// takes memory only where `numbers` is not yet large enough.
void set_visibility_order(const std::vector<TextureBrick>& bricks, const Grid& grid,
                          const View& view, Order order, std::vector<std::size_t>& numbers);

}  // namespace lamina

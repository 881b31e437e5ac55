// SPDX-License-Identifier: Apache-2.0
#include "plan/brick_cuts.h"

#include <algorithm>

#include "base/error.h"

namespace lamina {
namespace {

std::uint64_t bytes_of_brick(const TextureBrick& brick, std::uint64_t texel) {
    return static_cast<std::uint64_t>(brick.size[0]) * static_cast<std::uint64_t>(brick.size[1]) *
           static_cast<std::uint64_t>(brick.size[2]) * texel;
}

}  // namespace

std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities) {
    std::array<std::int64_t, 3> samples = grid.size, border{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        border[axis] = bordered && grid.index_min()[static_cast<int>(axis)] < 0 ? 1 : 0;
        samples[axis] += 2 * border[axis];
    }
    std::array<std::int64_t, 3> parts{1, 1, 1}, cells{};
    TextureBrick largest;
    while (true) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t all = std::max<std::int64_t>(samples[axis] - 1, 1);
            cells[axis] = (all + parts[axis] - 1) / parts[axis];
            largest.size[axis] = std::min(cells[axis] + 1, samples[axis]);
        }
        const std::size_t longest = static_cast<std::size_t>(
            std::max_element(largest.size.begin(), largest.size.end()) - largest.size.begin());
        if (largest.size[longest] <= capabilities.max_3d_texture_size &&
            bytes_of_brick(largest, texel_bytes) <= capabilities.max_texture_bytes) {
            break;
        }
        if (largest.size[longest] <= 2) {
            fail("volume: a brick of {} bytes does not fit a texture of {}: {}",
                 bytes_of_brick(largest, texel_bytes), capabilities.max_texture_bytes,
                 capabilities.renderer);
        }
        ++parts[longest];
    }
    std::vector<TextureBrick> bricks;
    std::array<std::int64_t, 3> at{};
    const auto last_cell = [&](std::size_t axis) {
        return std::max<std::int64_t>(samples[axis] - 1, 1);
    };
    for (at[2] = 0; at[2] < last_cell(2); at[2] += cells[2]) {
        for (at[1] = 0; at[1] < last_cell(1); at[1] += cells[1]) {
            for (at[0] = 0; at[0] < last_cell(0); at[0] += cells[0]) {
                TextureBrick brick{at, {}, bordered};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    brick.size[axis] = std::min(cells[axis] + 1, samples[axis] - at[axis]);
                    brick.first[axis] -= border[axis];
                }
                bricks.push_back(brick);
            }
        }
    }
    return bricks;
}

}  // namespace lamina

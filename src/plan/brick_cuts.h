// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lamina/grid.h"
#include "plan/capabilities.h"

namespace lamina {

// A box of the volume's samples that one texture holds: samples first .. first + size - 1.
// Neighbouring bricks share a layer of samples.
struct TextureBrick {
    std::array<std::int64_t, 3> first{0, 0, 0};
    std::array<std::int64_t, 3> size{1, 1, 1};
    // True: at the volume's border the texture holds one more layer, which repeats the border
    // sample, so that its samples reach as far as the volume's box.
    bool bordered = false;

    friend bool operator==(const TextureBrick&, const TextureBrick&) = default;
};

// Cuts the volume into the fewest bricks that respect the context's limits: the longest edge is cut
// once more until all fit. `bordered`: bricks get one more sample at both ends of each `cell` axis,
// which repeats the border. The half voxels there then lie between samples of the brick, and no
// other sample, which may be NaN, is read with a weight of 0. Throws Error if even two samples
// along an axis are too many.
std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities);

}  // namespace lamina

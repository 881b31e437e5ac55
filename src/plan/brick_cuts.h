// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "plan/plan.h"

namespace lamina {

// The fewest bricks that respect the context's limits: always the longest edge is cut once more.
// `bordered`: with one sample more at both ends of `cell` axes, which repeats the border, so that
// the half voxels there lie between samples that are theirs, and no other sample, which may be NaN,
// is taken with a weight of 0. Throws Error where two samples along an axis are too many.
std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities);

}  // namespace lamina

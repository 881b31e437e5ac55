// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/plan.h"

namespace lamina {

// The fewest bricks that respect the context's limits: always the longest edge is cut once more.
// Throws Error where two samples along an axis are too many.
std::vector<TextureBrick> cut_into_bricks(const Grid& grid, std::uint64_t texel_bytes,
                                          const Capabilities& capabilities);

}  // namespace lamina

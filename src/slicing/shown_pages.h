// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "facts/volume_facts.h"
#include "lamina/grid.h"
#include "scene/camera.h"
#include "slicing/tile_volume.h"

namespace lamina {

// Returns the numbers of the pages of a volume with cells in visible bricks, ascending. `share`:
// only bricks that touch this box count (SlicePlan::share).
std::vector<std::uint32_t> pages_shown(const TileVolume& volume, const OccupiedBricks& occupied,
                                       const std::optional<IndexBox>& share);

// Returns those of `pages` that may be in the view. `count`: pages along each axis; `first`: the
// volume's sample with which the first begins.
std::vector<std::uint32_t> pages_seen(const std::vector<std::uint32_t>& pages,
                                      const std::array<std::int64_t, 3>& count,
                                      const std::array<std::int64_t, 3>& first, const Grid& grid,
                                      const View& view);

}  // namespace lamina

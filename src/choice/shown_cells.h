// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Returns world points whose hull is that of all cells for which `shows` holds. `shows` gets the
// least and the greatest finite sample at a cell's corners; if it holds for a range it must hold
// for every wider one. The outermost cells include the half voxels beyond the samples of `cell`
// axes. In large volumes (choice/shown_cells.h) bricks take the place of cells. Neither order nor
// direction of the stored axes changes the hull. Parallel; empty if nothing shows.
std::vector<glm::dvec3> hull_of_shown_cells(const Volume& volume, const MinMaxBricks& bricks,
                                            const std::function<bool(const ValueRange&)>& shows);

// Number of samples above which a volume may lie on disk, so that fewer samples are used to choose
// a camera and extinctions. Volumes in memory use just as many, so that the picture is the same.
constexpr std::int64_t large_volume = std::int64_t{1} << 28;

}  // namespace lamina

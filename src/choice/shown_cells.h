// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Returns world points whose hull is that of all cells for which `shows` holds. `shows` gets the
// least and the greatest finite sample at a cell's corners; if it holds for a range it must hold
// for every wider one. The outermost cells include the half voxels beyond the samples of `cell`
// axes. In large volumes (choice/large_volume.h) bricks take the place of cells. Neither order nor
// direction of the stored axes changes the hull. Parallel; empty if nothing shows.
std::vector<glm::dvec3> hull_of_shown_cells(const Volume& volume, const MinMaxBricks& bricks,
                                            const std::function<bool(const ValueRange&)>& shows);

}  // namespace lamina

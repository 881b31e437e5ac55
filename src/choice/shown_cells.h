// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Points of the world whose hull is that of all cells for which `shows` holds, where `shows` is
// given the least and the greatest finite sample at a cell's corners and holds for a range where it
// holds for a part of it. The outermost cells also hold the half voxels beyond the samples of
// `cell` axes. Of large volumes (choice/large_volume.h) bricks take the cells' place. Neither the
// order nor the direction of the stored axes changes the hull. Parallel; empty where nothing shows.
std::vector<glm::dvec3> hull_of_shown_cells(const Volume& volume, const MinMaxBricks& bricks,
                                            const std::function<bool(const ValueRange&)>& shows);

}  // namespace lamina

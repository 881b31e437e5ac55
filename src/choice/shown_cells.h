// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/sample_source.h"
#include "volume/volume_data.h"

namespace lamina {

// Returns world points whose convex hull holds all visible cells, outer half voxels included; none
// if no cell is visible. A cell is visible if shows(range of its corners' finite samples) is true;
// it must then be true for wider ranges, too. `inside`: the samples between which cells count, if
// not all do. In large volumes, bricks take the place of cells, and all of them count.
std::vector<glm::dvec3> hull_of_shown_cells(const Volume& volume, const MinMaxBricks& bricks,
                                            const std::function<bool(const ValueRange&)>& shows,
                                            const std::optional<SampleBox>& inside = {});

}  // namespace lamina

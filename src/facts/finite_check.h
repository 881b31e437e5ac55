// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "mesh/scalar_range.h"
#include "scene/scene_mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Throw Error if no value of the data is finite, or if some are not and the scene does not draw
// them transparent. `bricks`: those of the volume; `found`: the range of the mesh's scalar.
void check_finite(const Scene& scene, const Grid& grid, const MinMaxBricks& bricks);
void check_finite(const Scene& scene, const SceneMesh& mesh, const ScalarRange& found);

}  // namespace lamina

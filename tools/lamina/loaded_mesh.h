// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_stats.h"
#include "scene/scene_mesh.h"

namespace lamina {

// Counts for the statistics what the mesh has.
void report_mesh(const SceneMesh& mesh, RenderStats& stats);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_job.h"
#include "scene/scene_mesh.h"

namespace lamina {

// Says and counts what is noteworthy of the mesh that is rendered, once it is known that it can be
// drawn.
void report_mesh(const RenderRequest& request, const SceneMesh& mesh, RenderStats& stats);

}  // namespace lamina

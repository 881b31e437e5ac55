// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "render_job.h"
#include "scene/scene_mesh.h"

namespace lamina {

// The mesh of a scene that is rendered, read or made.
std::shared_ptr<const SceneMesh> load_mesh_data(const RenderRequest& request, RenderStats& stats);

// Says and counts what is noteworthy of it, once it is known that it can be drawn.
void report_mesh(const RenderRequest& request, const SceneMesh& mesh, RenderStats& stats);

}  // namespace lamina

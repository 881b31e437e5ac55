// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_job.h"
#include "scene/mesh_facts.h"
#include "scene/scene_mesh.h"

namespace lamina {

// A scene's mesh, read or made, and measured; what was found on the way is counted and said.
struct LoadedMesh {
    LoadedMesh(const RenderRequest& request, RenderStats& stats);

    SceneMesh data;
    MeshFacts facts;
};

}  // namespace lamina

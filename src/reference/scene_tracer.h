// SPDX-License-Identifier: Apache-2.0
// Traces what a scene shows, whatever its method.
#pragma once

#include "lamina/scene.h"
#include "reference/tracer.h"
#include "scene/scene.h"

namespace lamina {

// Traces to the scene's trace_tolerance; otherwise as trace_volume().
TraceResult trace(const Scene& scene, const Volume& volume, const TileDone& tile_done = {});

// `open_faces`: the tree of the mesh's open faces; built if not given.
TraceResult trace(const Scene& scene, const SceneMesh& mesh, const TileDone& tile_done = {});
TraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces,
                  const TileDone& tile_done = {});

}  // namespace lamina

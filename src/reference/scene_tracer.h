// SPDX-License-Identifier: Apache-2.0
// Traces the picture that a scene describes, whatever method the scene would be drawn with.
#pragma once

#include "lamina/scene.h"
#include "reference/tracer.h"
#include "scene/scene.h"

namespace lamina {

// Traces with the scene's trace_tolerance; everything else is as in trace_volume().
TraceResult trace(const Scene& scene, const Volume& volume, const TileDone& tile_done = {});

// `open_faces` is the tree of the mesh's open faces. The overload without it builds the tree.
TraceResult trace(const Scene& scene, const SceneMesh& mesh, const TileDone& tile_done = {});
TraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces,
                  const TileDone& tile_done = {});

}  // namespace lamina

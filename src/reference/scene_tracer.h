// SPDX-License-Identifier: Apache-2.0
// Traces the picture that a scene describes, whatever method the scene would be drawn with.
#pragma once

#include "lamina/scene.h"
#include "reference/tracer.h"
#include "scene/scene.h"

namespace lamina {

// Traces to the error trace_tolerance of the scene; otherwise as trace_volume().
TraceResult trace(const Scene& scene, const Volume& volume, const TileDone& tile_done = {});

// `open_faces`: the tree of the mesh's open faces; without it, it is built.
TraceResult trace(const Scene& scene, const SceneMesh& mesh, const TileDone& tile_done = {});
TraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces,
                  const TileDone& tile_done = {});

}  // namespace lamina

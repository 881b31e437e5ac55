// SPDX-License-Identifier: Apache-2.0
// The reference for the picture that a scene shows of its data. The scene's method does not matter:
// these trace what any method draws.
#pragma once

#include "lamina/scene.h"
#include "reference/mesh_tracer.h"
#include "reference/volume_tracer.h"
#include "scene/scene_mesh.h"

namespace lamina {

// Traces to the scene's trace_tolerance; otherwise as trace_volume().
TraceResult trace(const Scene& scene, const Volume& volume, const TileDone& tile_done = {});

// Traces as trace_mesh() does. `open_faces`: the tree of the mesh's open faces, for callers who
// trace several pictures; it is built if it is not given.
MeshTraceResult trace(const Scene& scene, const SceneMesh& mesh, const TileDone& tile_done = {});
MeshTraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces,
                      const TileDone& tile_done = {});

}  // namespace lamina

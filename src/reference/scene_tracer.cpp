// SPDX-License-Identifier: Apache-2.0
#include "reference/scene_tracer.h"

namespace lamina {
namespace {

View view_of(const Scene& scene) {
    return View(*scene.camera, scene.width, scene.height);
}

TraceOptions options_of(const Scene& scene) {
    return {scene.trace_tolerance, scene.lighting, half_spaces(scene.clip)};
}

}  // namespace

TraceResult trace(const Scene& scene, const Volume& volume, const TileDone& tile_done) {
    return trace_volume(volume, *scene.transfer_function, view_of(scene), options_of(scene),
                        tile_done);
}

MeshTraceResult trace(const Scene& scene, const SceneMesh& mesh, const TileDone& tile_done) {
    return trace(scene, mesh, FaceTree(mesh.mesh, mesh.mesh.open_faces()), tile_done);
}

MeshTraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces,
                      const TileDone& tile_done) {
    return trace_mesh(mesh.mesh, open_faces, mesh.scalar.values, *scene.transfer_function,
                      view_of(scene), options_of(scene), tile_done);
}

}  // namespace lamina

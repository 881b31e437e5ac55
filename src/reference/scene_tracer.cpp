// SPDX-License-Identifier: Apache-2.0
#include "reference/scene_tracer.h"

namespace lamina {
namespace {

View view_of(const Scene& scene) {
    return View(scene.camera, scene.width, scene.height);
}

TraceOptions options_of(const Scene& scene) {
    return {scene.trace_tolerance, scene.lighting, half_spaces(scene.clip)};
}

}  // namespace

TraceResult trace(const Scene& scene, const Volume& volume) {
    return trace_volume(volume, scene.transfer_function, view_of(scene), options_of(scene));
}

MeshTraceResult trace(const Scene& scene, const SceneMesh& mesh) {
    return trace(scene, mesh, FaceTree(mesh.mesh, mesh.mesh.open_faces()));
}

MeshTraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces) {
    return trace_mesh(mesh.mesh, open_faces, mesh.scalar.values, scene.transfer_function,
                      view_of(scene), options_of(scene));
}

}  // namespace lamina

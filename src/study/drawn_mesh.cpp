// SPDX-License-Identifier: Apache-2.0
#include "study/drawn_mesh.h"

#include <utility>

#include "study/picture_key.h"

namespace lamina {
DrawnMesh::DrawnMesh(SceneMesh mesh)
    : mesh_(std::move(mesh)), open_faces_(mesh_.mesh, mesh_.mesh.open_faces()) {}

std::unique_ptr<GlProjectRenderer> DrawnMesh::renderer(const Scene& scene,
                                                       const Capabilities& capabilities) const {
    const Plan plan = make_plan(scene, measure_for(scene), capabilities, {});
    return std::make_unique<GlProjectRenderer>(mesh_, scene.transfer_function, plan.project,
                                               capabilities, scene.width, scene.height);
}

Image DrawnMesh::draw(const Scene& scene, const Capabilities& capabilities) const {
    const auto drawing = renderer(scene, capabilities);
    drawing->draw(View(scene.camera, scene.width, scene.height));
    return drawing->read();
}

MeshTraceResult DrawnMesh::trace(const Scene& scene) const {
    return trace_mesh(mesh_.mesh, open_faces_, mesh_.scalar.values, scene.transfer_function,
                      View(scene.camera, scene.width, scene.height));
}

const PreciseImage& DrawnMesh::exact(const Scene& scene) {
    const std::string key = picture_key(scene);
    const auto found = traced_.find(key);
    if (found != traced_.end()) return found->second;
    return traced_.emplace(key, trace(scene).image).first->second;
}

}  // namespace lamina

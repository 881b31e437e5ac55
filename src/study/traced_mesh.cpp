// SPDX-License-Identifier: Apache-2.0
#include "study/traced_mesh.h"

#include <utility>

#include "reference/scene_tracer.h"
#include "study/picture_key.h"

namespace lamina::study {

TracedMesh::TracedMesh(SceneMesh mesh)
    : mesh_(std::make_shared<const SceneMesh>(std::move(mesh))),
      open_faces_(mesh_->mesh, mesh_->mesh.open_faces()) {}

MeshTraceResult TracedMesh::trace(const Scene& scene) const {
    return lamina::trace(scene, *mesh_, open_faces_);
}

const PreciseImage& TracedMesh::exact(const Scene& scene) {
    const std::string key = picture_key(scene);
    const auto found = traced_.find(key);
    if (found != traced_.end()) return found->second;
    return traced_.emplace(key, trace(scene).image).first->second;
}

}  // namespace lamina::study

// SPDX-License-Identifier: Apache-2.0
#include "study/traced_mesh.h"

#include <utility>

#include "study/picture_key.h"

namespace lamina::study {

TracedMesh::TracedMesh(SceneMesh mesh)
    : TracedMesh(SceneData(std::make_shared<const SceneMesh>(std::move(mesh)))) {}

TracedMesh::TracedMesh(SceneData data) : data_(std::move(data)), mesh_(data_.mesh({})) {
    data_.open_faces({});
}

TracedPicture TracedMesh::trace(const Scene& scene) {
    return trace_picture(as_trace(scene, TraceOf::mesh), data_);
}

const PreciseImage& TracedMesh::exact(const Scene& scene) {
    const std::string key = picture_key(scene);
    const auto found = traced_.find(key);
    if (found != traced_.end()) return found->second;
    return traced_.emplace(key, trace(scene).image).first->second;
}

}  // namespace lamina::study

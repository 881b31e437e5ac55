// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "mesh/face_tree.h"
#include "reference/mesh_tracer.h"
#include "scene/scene_mesh.h"

namespace lamina::study {

// A tetrahedral mesh that is drawn, and the tracer's pictures of it. The mesh that a scene names is
// ignored.
class TracedMesh {
  public:
    explicit TracedMesh(SceneMesh mesh);

    const TetMesh& tets() const { return mesh_->mesh; }
    const std::shared_ptr<const SceneMesh>& data() const { return mesh_; }

    MeshTraceResult trace(const Scene& scene) const;
    // The tracer's picture, made once for each transfer function, camera and size.
    const PreciseImage& exact(const Scene& scene);

  private:
    std::shared_ptr<const SceneMesh> mesh_;
    FaceTree open_faces_;
    std::map<std::string, PreciseImage> traced_;  // by picture_key()
};

}  // namespace lamina::study

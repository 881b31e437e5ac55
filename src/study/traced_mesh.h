// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "render/traced_picture.h"

namespace lamina::study {

// A tetrahedral mesh that is drawn, and the tracer's pictures of it. The mesh that a scene names is
// ignored.
class TracedMesh {
  public:
    explicit TracedMesh(SceneMesh mesh);
    explicit TracedMesh(SceneData data);  // which has a mesh

    const SceneMesh& mesh() const { return *mesh_; }
    const TetMesh& tets() const { return mesh_->mesh; }
    const SceneData& data() const { return data_; }

    TracedPicture trace(const Scene& scene);
    // The tracer's picture, made once for each transfer function, camera and size.
    const PreciseImage& exact(const Scene& scene);

  private:
    SceneData data_;
    std::shared_ptr<const SceneMesh> mesh_;       // that of data_
    std::map<std::string, PreciseImage> traced_;  // by picture_key()
};

}  // namespace lamina::study

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

#include "image/image.h"
#include "mesh/face_tree.h"
#include "projection/gl_project_renderer.h"
#include "reference/mesh_tracer.h"
#include "scene/capabilities.h"
#include "scene/plan.h"
#include "scene/scene_mesh.h"

namespace lamina {

// A tetrahedral mesh, ready for scenes that show it; what these say of their mesh is not read. To
// draw, the context of the capabilities must be current.
class DrawnMesh {
  public:
    explicit DrawnMesh(SceneMesh mesh);

    const TetMesh& tets() const { return mesh_.mesh; }
    const SceneMesh& data() const { return mesh_; }
    MeshFacts measure_for(const Scene& scene) const { return measure(scene, mesh_); }
    // As `lamina render` draws the scene by projection. The renderer refers to this mesh and to the
    // scene's transfer function.
    std::unique_ptr<GlProjectRenderer> renderer(const Scene& scene,
                                                const Capabilities& capabilities) const;
    Image draw(const Scene& scene, const Capabilities& capabilities) const;

    MeshTraceResult trace(const Scene& scene) const;
    // The tracer's picture, made once for a transfer function, camera and size.
    const PreciseImage& exact(const Scene& scene);

  private:
    SceneMesh mesh_;
    FaceTree open_faces_;
    std::map<std::string, PreciseImage> traced_;  // by picture_key()
};

}  // namespace lamina

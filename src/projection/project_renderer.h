// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "plan/frame_renderer.h"
#include "plan/plan.h"
#include "scene/scene_mesh.h"
#include "visibility/visibility_order.h"

namespace lamina {

class GlTetStream;

// Parts that the next renderer of the mesh can take over.
struct ProjectParts {
    std::shared_ptr<VisibilityOrder> order;
    std::shared_ptr<GlTetStream> stream;  // buffers of OpenGL
};

// Draws frames of a mesh. The following are about the last frame.
class ProjectRenderer : public FrameRenderer {
  public:
    virtual const OrderReport& order_report() const = 0;
    virtual std::int64_t tets_drawn() const = 0;  // tets that cover the centre of a pixel

    virtual ProjectParts parts() const = 0;

    // Makes the mesh live as long as the renderer.
    void keep(std::shared_ptr<const SceneMesh> mesh) { mesh_ = std::move(mesh); }
    const SceneMesh* kept_mesh() const { return mesh_.get(); }

  private:
    std::shared_ptr<const SceneMesh> mesh_;
};

// Returns an order that sorts the mesh's tets as the plan says: `ready`, of the same mesh or null,
// if it does.
std::shared_ptr<VisibilityOrder> order_for(const SceneMesh& mesh, const ProjectPlan& plan,
                                           std::shared_ptr<VisibilityOrder> ready);

// Makes a renderer that draws a mesh as the plan says, on the context of the capabilities: the
// engine `cpu`, or the current OpenGL context, which must outlive it, as must the mesh. `ready`:
// parts of a renderer of the same mesh and capabilities, which draws no more, or none.
std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height, const ProjectParts& ready = {});

}  // namespace lamina

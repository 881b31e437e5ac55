// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "plan/frame_renderer.h"
#include "plan/plan.h"
#include "scene/scene_mesh.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Draws frames of a mesh. The following are about the last frame.
class ProjectRenderer : public FrameRenderer {
  public:
    virtual const OrderReport& order_report() const = 0;
    virtual std::int64_t tets_drawn() const = 0;  // number of tets that cover the centre of a pixel
};

// Makes a renderer that draws a mesh as the plan says. The capabilities decide whether it is the
// native engine or OpenGL in the current context. The context and the mesh must outlive the
// renderer.
std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height);

}  // namespace lamina

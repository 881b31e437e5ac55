// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "visibility/visibility_order.h"
#include "plan/frame_renderer.h"
#include "plan/plan.h"
#include "scene/scene_mesh.h"

namespace lamina {

// Draws frames of a mesh. Both are of the last one.
class ProjectRenderer : public FrameRenderer {
  public:
    virtual const OrderReport& order_report() const = 0;
    virtual std::int64_t tets_drawn() const = 0;  // that cover the centre of a pixel
};

// Draws a mesh as the plan says with what the capabilities are of: the native engine, or the
// current OpenGL context, which must outlive it, as must the mesh.
std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height);

}  // namespace lamina

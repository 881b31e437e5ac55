// SPDX-License-Identifier: Apache-2.0
#include "projection/project_renderer.h"

#include "base/profile.h"
#include "projection/cpu_project_renderer.h"
#include "projection/gl_mesh_walk.h"
#include "projection/gl_project_renderer.h"
#include "projection/gl_tet_codes.h"
#include "scene/camera.h"

namespace lamina {

ProjectRenderer::ProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                                 const ProjectPlan& plan, std::shared_ptr<VisibilityOrder> ready)
    : mesh_(mesh),
      transfer_function_(in_units(transfer_function, plan.unit)),
      plan_(plan),
      pieces_(transfer_function_, plan.range),
      order_(std::move(ready)) {
    const OrderMethod method =
        plan.nothing_visible || plan.walk ? OrderMethod::none : plan.visibility;
    if (!order_ || order_->method() != method)
        order_ = std::make_shared<VisibilityOrder>(
            mesh.mesh, method,
            plan.overlaps ? std::span(*plan.overlaps) : std::span<const TetPair>());
    if (plan_.nothing_visible) return;
    if (plan_.lighting) {
        const Stage stage("gradients");
        gradients_ = StoredGradients(gradients_of(mesh_), *plan_.lighting->smallest_gradient);
    }
    if (plan_.walk) return;
    const Stage cutting("visible parts");
    visible_.emplace(mesh_.mesh, mesh_.scalar.values, pieces_, plan_.source == SegmentSource::parts,
                     plan_.draw_transparent);
}

std::optional<TreeShape> ProjectRenderer::tree_shape() const {
    if (plan_.tree.empty() || !visible_ || visible_->count() == 0) return {};
    return TreeShape(plan_.tree, static_cast<int>(visible_->count()));
}

std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height, const ProjectReuse& ready) {
    if (capabilities.cpu) {
        return std::make_unique<CpuProjectRenderer>(mesh, transfer_function, plan, width, height,
                                                    ready.order);
    }
    if (plan.walk)
        return std::make_unique<GlMeshWalk>(mesh, transfer_function, plan, width, height,
                                            ready.order);
    if (plan.blending == Blending::registers)
        return std::make_unique<GlTetCodes>(mesh, transfer_function, plan, width, height,
                                            ready.order);
    return std::make_unique<GlProjectRenderer>(mesh, transfer_function, plan, capabilities, width,
                                               height, ready.order, ready.stream);
}

}  // namespace lamina

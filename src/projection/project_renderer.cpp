// SPDX-License-Identifier: Apache-2.0
#include "projection/project_renderer.h"

#include "projection/gl_project_renderer.h"
#include "projection/tile_project_renderer.h"

namespace lamina {

std::shared_ptr<VisibilityOrder> order_for(const SceneMesh& mesh, const ProjectPlan& plan,
                                           std::shared_ptr<VisibilityOrder> ready) {
    const OrderMethod method = plan.nothing_visible ? OrderMethod::none : plan.visibility;
    if (ready && ready->method() == method) return ready;
    return std::make_shared<VisibilityOrder>(mesh.mesh, method);
}

std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height, const ProjectParts& ready) {
    if (capabilities.tiles) {
        return std::make_unique<TileProjectRenderer>(mesh, transfer_function, plan, width, height,
                                                     ready.order);
    }
    return std::make_unique<GlProjectRenderer>(mesh, transfer_function, plan, capabilities, width,
                                               height, ready.order, ready.stream);
}

}  // namespace lamina

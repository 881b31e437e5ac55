// SPDX-License-Identifier: Apache-2.0
#include "projection/project_renderer.h"

#include "projection/gl_project_renderer.h"
#include "projection/tile_project_renderer.h"

namespace lamina {

std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height) {
    if (capabilities.tiles) {
        return std::make_unique<TileProjectRenderer>(mesh, transfer_function, plan, width, height);
    }
    return std::make_unique<GlProjectRenderer>(mesh, transfer_function, plan, capabilities, width,
                                               height);
}

}  // namespace lamina

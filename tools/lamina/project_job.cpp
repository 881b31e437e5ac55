// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "frame_job.h"
#include "loaded_mesh.h"
#include "projection/project_renderer.h"

namespace lamina {
namespace {

class ProjectMethod : public FrameMethod {
  public:
    explicit ProjectMethod(const RenderRequest& request) : request_(request) {}

    std::unique_ptr<SceneRenderer> open(const Capabilities& capabilities) override {
        return std::make_unique<SceneRenderer>(request_.scene, request_.data.mesh, capabilities,
                                               request_.omissions);
    }

    void report_plan(const Plan& /*plan*/, RenderStats& stats) override {
        report_mesh(*request_.data.mesh, stats);
    }

    void report_frame(const Plan& /*plan*/, const FrameRenderer& frames,
                      RenderStats& stats) const override {
        const auto& renderer = dynamic_cast<const ProjectRenderer&>(frames);
        stats.tets_drawn = renderer.tets_drawn();
        const OrderReport& order = renderer.order_report();
        stats.counts["cycles"] = order.cycles;
        stats.counts["cyclic_tets"] = order.cyclic_tets;
        stats.counts["pairs_in_wrong_order"] = order.broken;
    }

  private:
    const RenderRequest request_;
};

}  // namespace

std::unique_ptr<RenderJob> make_project_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<ProjectMethod>(request));
}

}  // namespace lamina

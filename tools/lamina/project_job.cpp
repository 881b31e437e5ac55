// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "frame_job.h"
#include "loaded_mesh.h"
#include "projection/project_renderer.h"

namespace lamina {
namespace {

class ProjectMethod : public FrameMethod {
  public:
    explicit ProjectMethod(const RenderRequest& request) : request_(request) {}

    const char* activity() const override { return "projecting"; }

    void load(RenderStats& stats) override { mesh_.emplace(request_, stats); }

    Plan plan(const Capabilities& capabilities) override {
        return make_plan(request_.scene, mesh_->facts, capabilities, request_.omissions);
    }

    std::string explanation(const Plan& plan, const Capabilities& capabilities) const override {
        return explain(plan, mesh_->facts, capabilities);
    }

    std::unique_ptr<FrameRenderer> make_renderer(const Plan& plan,
                                                 const Capabilities& capabilities) override {
        const Scene& scene = request_.scene;
        auto renderer = make_project_renderer(mesh_->data, scene.transfer_function, plan.project,
                                              capabilities, scene.width, scene.height);
        renderer_ = renderer.get();
        return renderer;
    }

    void report(RenderStats& stats) const override {
        stats.tets_drawn = renderer_->tets_drawn();
        const OrderReport& order = renderer_->order_report();
        stats.counts["cycles"] = order.cycles;
        stats.counts["cyclic_tets"] = order.cyclic_tets;
        stats.counts["pairs_in_wrong_order"] = order.broken;
        if (order.cycles > 0) {
            request_.message(fmt::format(
                "{} tets hide one another in {} rings: {} pairs are drawn in the wrong order",
                order.cyclic_tets, order.cycles, order.broken));
        }
    }

  private:
    const RenderRequest request_;
    std::optional<LoadedMesh> mesh_;
    const ProjectRenderer* renderer_ = nullptr;  // that make_renderer() made
};

}  // namespace

std::unique_ptr<RenderJob> make_project_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<ProjectMethod>(request));
}

}  // namespace lamina

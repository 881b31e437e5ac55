// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "base/stopwatch.h"
#include "clamped_colors.h"
#include "context_kind.h"
#include "first_frame.h"
#include "gl/context.h"
#include "loaded_mesh.h"
#include "projection/gl_project_renderer.h"
#include "render_job.h"

namespace lamina {
namespace {

class ProjectJob : public RenderJob {
  public:
    explicit ProjectJob(const RenderRequest& request) : request_(request) {}

    Plan plan(RenderStats& stats) override {
        mesh_.emplace(request_, stats);
        const Stopwatch context_watch;
        context_ = gl::Context::create(context_kind(request_.context));
        stats.stages_ms["context"] = context_watch.milliseconds();
        stats.context = context_->capabilities().renderer;
        const Stopwatch plan_watch;
        Plan plan =
            make_plan(request_.scene, mesh_->facts, context_->capabilities(), request_.omissions);
        stats.stages_ms["plan"] = plan_watch.milliseconds();
        return plan;
    }

    std::string explanation(const Plan& plan) const override {
        return explain(plan, mesh_->facts, context_->capabilities());
    }

    void draw(const Plan& plan, const View& view, RenderStats& stats) override {
        const Scene& scene = request_.scene;
        count_clamped_colors(request_, stats);
        const Stopwatch set_up_watch;
        renderer_.emplace(mesh_->data, scene.transfer_function, plan.project,
                          context_->capabilities(), scene.width, scene.height);
        stats.stages_ms["set_up"] = set_up_watch.milliseconds();
        image_.emplace(draw_first_frame(*renderer_, "projecting", request_, view, stats));
        record_stages(stats);
        report_order(stats);
        stats.tets_drawn = renderer_->tets_drawn();
    }

    void draw_frame(const View& view) override { renderer_->draw(view); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(*image_, request_.scene.background, attributes);
    }

  private:
    void record_stages(RenderStats& stats) const {
        stats.stages_ms["tables"] = renderer_->table_ms();
        stats.stages_ms["order"] = renderer_->order_ms();
        stats.stages_ms["geometry"] = renderer_->geometry_ms();
        stats.stages_ms["draw"] = renderer_->draw_ms();
    }

    void report_order(RenderStats& stats) const {
        const OrderReport& report = renderer_->order_report();
        stats.counts["cycles"] = report.cycles;
        stats.counts["cyclic_tets"] = report.cyclic_tets;
        stats.counts["pairs_in_wrong_order"] = report.broken;
        if (report.cycles > 0) {
            request_.message(fmt::format(
                "{} tets hide one another in {} rings: {} pairs are drawn in the wrong order",
                report.cyclic_tets, report.cycles, report.broken));
        }
    }

    const RenderRequest request_;
    std::optional<LoadedMesh> mesh_;
    std::unique_ptr<gl::Context> context_;
    std::optional<GlProjectRenderer> renderer_;
    std::optional<Image> image_;
};

}  // namespace

std::unique_ptr<RenderJob> make_project_job(const RenderRequest& request) {
    return std::make_unique<ProjectJob>(request);
}

}  // namespace lamina

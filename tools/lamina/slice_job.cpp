// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "base/stopwatch.h"
#include "clamped_colors.h"
#include "context_kind.h"
#include "first_frame.h"
#include "gl/context.h"
#include "loaded_volume.h"
#include "render_job.h"
#include "slicing/gl_slice_renderer.h"

namespace lamina {
namespace {

class SliceJob : public RenderJob {
  public:
    explicit SliceJob(const RenderRequest& request) : request_(request) {}

    Plan plan(RenderStats& stats) override {
        data_.emplace(request_, stats);
        const Stopwatch watch;
        context_ = gl::Context::create(context_kind(request_.context));
        stats.stages_ms["context"] = watch.milliseconds();
        stats.context = context_->capabilities().renderer;
        return make_plan(request_.scene, data_->facts, context_->capabilities(),
                         request_.omissions);
    }

    std::string explanation(const Plan& plan) const override {
        return explain(plan, data_->facts, context_->capabilities());
    }

    void draw(const Plan& plan, const View& view, RenderStats& stats) override {
        const Scene& scene = request_.scene;
        count_clamped_colors(request_, stats);
        renderer_.emplace(data_->volume, scene.transfer_function, data_->facts, plan.slice,
                          context_->capabilities(), scene.width, scene.height);
        image_.emplace(draw_first_frame(*renderer_, "slicing", request_, view, stats));
        stats.stages_ms["tables"] = renderer_->table_ms();
        stats.stages_ms["upload"] = renderer_->upload_ms();
        stats.stages_ms["geometry"] = renderer_->geometry_ms();
        stats.stages_ms["draw"] = renderer_->draw_ms();
        stats.samples = plan.slice.slabs;
    }

    void draw_frame(const View& view) override { renderer_->draw(view); }

    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override {
        return picture.write(*image_, request_.scene.background, attributes);
    }

  private:
    const RenderRequest request_;
    std::optional<LoadedVolume> data_;
    std::unique_ptr<gl::Context> context_;
    std::optional<GlSliceRenderer> renderer_;
    std::optional<Image> image_;
};

}  // namespace

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request) {
    return std::make_unique<SliceJob>(request);
}

}  // namespace lamina

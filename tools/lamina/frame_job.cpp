// SPDX-License-Identifier: Apache-2.0
#include "frame_job.h"

#include "base/progress.h"
#include "base/stage.h"
#include "clamped_colors.h"
#include "gl/memory.h"
#include "gl/query.h"

namespace lamina {

FrameJob::FrameJob(const RenderRequest& request, std::unique_ptr<FrameMethod> method)
    : request_(request), method_(std::move(method)) {}

Plan FrameJob::plan(RenderStats& stats) {
    method_->load(stats);
    Stage opening("context");
    context_.emplace(request_.context);
    stats.stages_ms["context"] = opening.end();
    stats.renderer = context_->capabilities().renderer;
    stats.context = renderer_and_threads(context_->capabilities());
    stats.on_tiles = context_->capabilities().tiles;
    Stage planning("plan");
    Plan plan = method_->plan(context_->capabilities());
    stats.stages_ms["plan"] = planning.end();
    return plan;
}

std::string FrameJob::explanation(const Plan& plan) const {
    return method_->explanation(plan, context_->capabilities());
}

void FrameJob::draw(const Plan& plan, const View& view, RenderStats& stats) {
    count_clamped_colors(request_, stats);
    Stage setting_up("set_up");
    renderer_ = method_->make_renderer(plan, context_->capabilities());
    stats.stages_ms["set_up"] = setting_up.end();
    Stage frame("frame");
    frame.count("frame", 0);
    draw_first(view, stats);
    stats.frames_ms = {frame.end()};
    Stage reading("read");
    image_.emplace(renderer_->read());
    stats.stages_ms["read"] = reading.end();
    stats.bytes_gpu = gl::bytes_allocated();
    stats.bytes_host = renderer_->byte_count();
    stats.stages_ms.merge(renderer_->stages_ms());
    method_->report(stats);
}

// With its progress and, where somebody will read them, its fragments.
void FrameJob::draw_first(const View& view, RenderStats& stats) {
    Progress progress(method_->activity(), renderer_->step_count());
    if (!request_.count_fragments || context_->capabilities().tiles) {
        renderer_->draw(view, &progress);
        stats.fragments = static_cast<std::uint64_t>(renderer_->fragments());
        return;
    }
    gl::Query query(gl::Query::Kind::samples_passed);
    query.begin();
    renderer_->draw(view, &progress);
    query.end();
    stats.fragments = query.result();
}

void FrameJob::draw_frame(const View& view) {
    renderer_->draw(view);
}

std::size_t FrameJob::write(PictureFile& picture, const PictureAttributes& attributes) {
    return picture.write(*image_, request_.scene.background, attributes);
}

}  // namespace lamina

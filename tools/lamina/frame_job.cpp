// SPDX-License-Identifier: Apache-2.0
#include "frame_job.h"

#include "base/progress.h"
#include "base/stopwatch.h"
#include "clamped_colors.h"
#include "gl/memory.h"
#include "gl/query.h"

namespace lamina {

FrameJob::FrameJob(const RenderRequest& request, std::unique_ptr<FrameMethod> method)
    : request_(request), method_(std::move(method)) {}

Plan FrameJob::plan(RenderStats& stats) {
    method_->load(stats);
    const Stopwatch context_watch;
    context_.emplace(request_.context);
    stats.stages_ms["context"] = context_watch.milliseconds();
    stats.context = context_->capabilities().renderer;
    const Stopwatch plan_watch;
    Plan plan = method_->plan(context_->capabilities());
    stats.stages_ms["plan"] = plan_watch.milliseconds();
    return plan;
}

std::string FrameJob::explanation(const Plan& plan) const {
    return method_->explanation(plan, context_->capabilities());
}

void FrameJob::draw(const Plan& plan, const View& view, RenderStats& stats) {
    count_clamped_colors(request_, stats);
    const Stopwatch set_up_watch;
    renderer_ = method_->make_renderer(plan, context_->capabilities());
    stats.stages_ms["set_up"] = set_up_watch.milliseconds();
    const Stopwatch frame_watch;
    draw_first(view, stats);
    stats.frames_ms = {frame_watch.milliseconds()};
    const Stopwatch read_watch;
    image_.emplace(renderer_->read());
    stats.stages_ms["read"] = read_watch.milliseconds();
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

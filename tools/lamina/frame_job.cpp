// SPDX-License-Identifier: Apache-2.0
#include "frame_job.h"

#include "base/stage.h"
#include "gl/memory.h"
#include "gl/query.h"
#include "render/context_choice.h"
#include "render/warnings.h"

namespace lamina {

FrameJob::FrameJob(const RenderRequest& request, std::unique_ptr<FrameMethod> method)
    : request_(request), method_(std::move(method)) {}

Plan FrameJob::plan(RenderStats& stats) {
    Stage opening("context");
    const bool in_files = request_.data.volume && !request_.data.volume->volume.in_memory();
    context_.emplace(in_files ? context_for_files(request_.context) : request_.context);
    current_ = context_->make_current();
    stats.stages_ms["context"] = opening.end();
    stats.renderer = context_->capabilities().renderer;
    stats.context = renderer_and_threads(context_->capabilities());
    stats.on_tiles = context_->capabilities().tiles;
    frames_ = method_->open(context_->capabilities());
    Plan plan = frames_->plan();
    const auto& took = frames_->stages_ms();
    stats.stages_ms["measure"] += took.at("facts") + took.at("trials");
    stats.stages_ms["plan"] = took.at("plan");
    method_->report_plan(plan, stats);
    warn_of_all(frames_->warnings());
    return plan;
}

std::string FrameJob::explanation(const Plan& /*plan*/) const {
    return frames_->explanation();
}

void FrameJob::draw(const Plan& plan, RenderStats& stats) {
    stats.counts["clamped_colors"] = clamped_colors(frames_->resolved_scene());
    frames_->set_up();
    stats.stages_ms["set_up"] = frames_->stages_ms().at("set_up");
    Stage frame("frame");
    frame.count("frame", 0);
    draw_first(stats);
    stats.frames_ms = {frame.end()};
    Stage reading("read");
    image_.emplace(frames_->picture());
    stats.stages_ms["read"] = reading.end();
    warn_of_all(frames_->warnings());
    warn_of_picture(request_.scene, *request_.data.field(), *image_);
    const FrameRenderer& renderer = frames_->renderer();
    stats.bytes_gpu = gl::bytes_allocated();
    stats.bytes_host = renderer.byte_count();
    stats.stages_ms.merge(renderer.stages_ms());
    method_->report_frame(plan, renderer, stats);
}

// Fragments are counted only where somebody will read their number.
void FrameJob::draw_first(RenderStats& stats) {
    if (!request_.count_fragments || context_->capabilities().tiles) {
        frames_->draw();
        stats.fragments = static_cast<std::uint64_t>(frames_->renderer().fragments());
        return;
    }
    gl::Query query(gl::Query::Kind::samples_passed);
    query.begin();
    frames_->draw();
    query.end();
    stats.fragments = query.result();
}

void FrameJob::draw_frame(const Camera& camera) {
    frames_->set_camera(camera);
    frames_->draw();
}

void FrameJob::draw_view(const Camera& camera, const Plan& plan, RenderStats& stats) {
    frames_->set_camera(camera);
    if (!image_) return draw(plan, stats);
    Stage frame("frame");
    frame.count("frame", static_cast<double>(stats.frames_ms.size()));
    frames_->draw();
    stats.frames_ms.push_back(frame.end());
    frames_->read(*image_);
    warn_of_all(frames_->warnings());
    RenderStats view;
    method_->report_frame(plan, frames_->renderer(), view);
    keep_largest(view.counts, stats.counts);
}

std::size_t FrameJob::write(PictureFile& picture, const PictureAttributes& attributes) {
    return picture.write(*image_, request_.scene.background, attributes,
                         request_.scene.color_space);
}

}  // namespace lamina

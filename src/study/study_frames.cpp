// SPDX-License-Identifier: Apache-2.0
#include "study/study_frames.h"

#include <utility>

#include "base/profile.h"
#include "gl/api.h"

namespace lamina::study {

const Capabilities& DrawContexts::use(const std::string& word) {
    const auto found = contexts_.find(word);
    if (found != contexts_.end()) return found->second.capabilities();
    const Auto<ContextChoice> choice = context_choice(word);
    if (choice != ContextChoice::cpu) {
        before_switch_();
        current_.reset();
        std::erase_if(contexts_,
                      [](const auto& context) { return !context.second.capabilities().tiles; });
    }
    const DrawContext& context = contexts_.try_emplace(word, choice).first->second;
    if (!context.capabilities().tiles) current_ = context.make_current();
    return context.capabilities();
}

StudyFrames::StudyFrames(const Scene& scene, DataStore& data, const Capabilities& capabilities,
                         std::shared_ptr<TableCache> tables)
    : camera_(*scene.camera),
      pipeline_(std::make_unique<Pipeline>(
          scene, data.data_of(scene),
          PipelineOptions{.capabilities = capabilities, .tables = std::move(tables)})) {
    pipeline_->load();
    const std::int64_t before = gl::bytes_allocated();
    const Stopwatch watch;
    pipeline_->draw_frame();
    first_ms_ = watch.milliseconds();
    set_up_ms_ = pipeline_->statistics().stages_ms.at("set_up");
    bytes_gpu_ = gl::bytes_allocated() - before;
    // Errors above max_error are what a study is about; its report has them.
    if (scene.method == Method::project) pipeline_->warn_of_plan();
}

void StudyFrames::draw() {
    if (turned_) pipeline_->set_camera(camera_);
    turned_ = false;
    pipeline_->draw_frame();
}

void StudyFrames::draw_turned(double degrees) {
    turned_ = true;
    pipeline_->set_camera(turned(camera_, degrees));
    pipeline_->draw_frame();
}

}  // namespace lamina::study

// SPDX-License-Identifier: Apache-2.0
#include "study/study_frames.h"

#include "base/stopwatch.h"
#include "gl/memory.h"

namespace lamina::study {
namespace {

std::unique_ptr<SceneRenderer> frames_of(const Scene& scene, DataStore& data,
                                         const Capabilities& capabilities) {
    if (scene.method == Method::project)
        return std::make_unique<SceneRenderer>(scene, data.mesh(scene).data.data(), capabilities);
    return std::make_unique<SceneRenderer>(scene, data.volume(scene).data, capabilities);
}

}  // namespace

StudyFrames::StudyFrames(const Scene& scene, DataStore& data, const Capabilities& capabilities)
    : camera_(scene.camera), frames_(frames_of(scene, data, capabilities)) {
    const std::int64_t before = gl::bytes_allocated();
    const Stopwatch watch;
    frames_->draw();
    first_ms_ = watch.milliseconds();
    set_up_ms_ = frames_->stages_ms().at("set_up");
    bytes_gpu_ = gl::bytes_allocated() - before;
}

void StudyFrames::draw() {
    if (turned_) frames_->set_camera(camera_);
    turned_ = false;
    frames_->draw();
}

void StudyFrames::draw_turned(double degrees) {
    turned_ = true;
    frames_->set_camera(turned(camera_, degrees));
    frames_->draw();
}

}  // namespace lamina::study

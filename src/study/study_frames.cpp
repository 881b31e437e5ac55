// SPDX-License-Identifier: Apache-2.0
#include "study/study_frames.h"

#include "base/stopwatch.h"
#include "choice/choose.h"
#include "choice/mesh_field.h"
#include "choice/volume_field.h"
#include "gl/memory.h"

namespace lamina::study {
namespace {

// The smallest gradient of lighting may be open: it follows from the data alone.
Scene chosen_for(const Scene& scene, DataStore& data) {
    if (!leaves_something_open(scene)) return scene;
    if (scene.draws_mesh() && !scene.mesh_file.empty())
        return choose(scene, MeshField(*data.mesh(scene).data.data()));
    const VolumeData& volume = *data.volume(scene).data;
    return choose(scene, VolumeField(volume));
}

std::unique_ptr<SceneRenderer> frames_of(const Scene& asked, DataStore& data,
                                         const Capabilities& capabilities) {
    const Scene scene = chosen_for(asked, data);
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
    // Errors above max_error are what a study is about; its report has them.
    if (scene.method == Method::project) warn_of_all(frames_->warnings());
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

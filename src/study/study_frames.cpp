// SPDX-License-Identifier: Apache-2.0
#include "study/study_frames.h"

#include <utility>

#include "base/stopwatch.h"
#include "gl/memory.h"
#include "projection/project_renderer.h"
#include "slicing/slice_renderer.h"

namespace lamina {

StudyFrames::StudyFrames(Scene scene, DataStore& data, const Capabilities& capabilities)
    : scene_(std::make_unique<Scene>(std::move(scene))), on_tiles_(capabilities.tiles) {
    const std::int64_t before = gl::bytes_allocated();
    renderer_ = make(data, capabilities);
    draw();
    bytes_gpu_ = gl::bytes_allocated() - before;
}

std::unique_ptr<FrameRenderer> StudyFrames::make(DataStore& data,
                                                 const Capabilities& capabilities) {
    if (scene_->method == Method::project) {
        const DrawnMesh& mesh = data.mesh(*scene_).data;
        const Plan plan = make_plan(*scene_, mesh.measure_for(*scene_), capabilities, {});
        const Stopwatch watch;
        auto renderer = make_project_renderer(mesh.data(), scene_->transfer_function, plan.project,
                                              capabilities, scene_->width, scene_->height);
        set_up_ms_ = watch.milliseconds();
        return renderer;
    }
    const DrawnVolume& volume = data.volume(*scene_).data;
    const Facts facts = volume.measure_for(*scene_, capabilities);
    const Plan plan = make_plan(*scene_, facts, capabilities, {});
    const Stopwatch watch;
    auto renderer = make_slice_renderer(volume.volume(), scene_->transfer_function, facts,
                                        plan.slice, capabilities, scene_->width, scene_->height);
    set_up_ms_ = watch.milliseconds();
    return renderer;
}

void StudyFrames::draw_turned(double degrees) {
    renderer_->draw(View(turned(scene_->camera, degrees), scene_->width, scene_->height));
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "scene/frame_renderer.h"
#include "study/data_store.h"

namespace lamina {

// A scene of method slice or project, set up to be drawn again and again. The data and the context
// must outlive it.
class StudyFrames {
  public:
    StudyFrames(Scene scene, DataStore& data, const Capabilities& capabilities);

    void draw() { renderer_->draw(View(scene_->camera, scene_->width, scene_->height)); }
    // With the scene's eye turned about its centre.
    void draw_turned(double degrees);

    const Scene& scene() const { return *scene_; }
    FrameRenderer& renderer() { return *renderer_; }
    double set_up_ms() const { return set_up_ms_; }
    bool on_tiles() const { return on_tiles_; }
    std::int64_t bytes_gpu() const { return bytes_gpu_; }  // OpenGL's, once it has drawn
    std::int64_t bytes_host() const { return renderer_->byte_count(); }
    std::int64_t bytes() const { return bytes_gpu() + bytes_host(); }

  private:
    std::unique_ptr<FrameRenderer> make(DataStore& data, const Capabilities& capabilities);

    std::unique_ptr<Scene> scene_;  // its transfer function is the renderer's
    std::unique_ptr<FrameRenderer> renderer_;
    bool on_tiles_;
    double set_up_ms_ = 0;
    std::int64_t bytes_gpu_ = 0;
};

}  // namespace lamina

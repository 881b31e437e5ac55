// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "study/drawn_mesh.h"
#include "study/interleaved_times.h"

namespace lamina {

// A scene of a mesh, set up to be drawn again and again. The mesh and the context must outlive it.
class MeshFrame {
  public:
    MeshFrame(std::string name, const DrawnMesh& mesh, Scene scene,
              const Capabilities& capabilities)
        : name_(std::move(name)),
          scene_(std::make_unique<Scene>(std::move(scene))),
          view_(scene_->camera, scene_->width, scene_->height),
          renderer_(mesh.renderer(*scene_, capabilities)) {}

    const std::string& name() const { return name_; }
    const GlProjectRenderer& renderer() const { return *renderer_; }
    // Order, geometry and fragments.
    void draw() {
        renderer_->draw(view_);
        drawn_ = true;
    }
    void warm_up() {
        if (!drawn_) draw();
    }

  private:
    std::string name_;
    std::unique_ptr<Scene> scene_;  // its transfer function is the renderer's
    View view_;
    std::unique_ptr<GlProjectRenderer> renderer_;
    bool drawn_ = false;
};

// For time_interleaved(): whole frames. `frames` must stay where they are.
inline std::vector<TimedFrame> timed(std::vector<MeshFrame>& frames) {
    std::vector<TimedFrame> all;
    for (MeshFrame& frame : frames) {
        all.push_back({frame.name(), [&frame] { frame.warm_up(); }, [&frame] { frame.draw(); }});
    }
    return all;
}

}  // namespace lamina

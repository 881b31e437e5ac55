// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "projection/project_renderer.h"
#include "render/scene_renderer.h"
#include "study/interleaved_times.h"
#include "study/traced_mesh.h"

namespace lamina::papers {

// A scene of a mesh, prepared to be drawn again and again. The context must outlive it.
class MeshFrame {
  public:
    MeshFrame(std::string name, const study::TracedMesh& mesh, const Scene& scene,
              const Capabilities& capabilities)
        : name_(std::move(name)),
          frames_(std::make_unique<SceneRenderer>(scene, mesh.data(), capabilities)) {
        frames_->set_up();
    }

    const std::string& name() const { return name_; }
    const ProjectRenderer& renderer() const {
        return dynamic_cast<const ProjectRenderer&>(frames_->renderer());
    }
    Image picture() const { return frames_->picture(); }
    // Draws a whole frame: order, geometry and fragments.
    void draw() {
        frames_->draw();
        drawn_ = true;
    }
    void warm_up() {
        if (!drawn_) draw();
    }

  private:
    std::string name_;
    std::unique_ptr<SceneRenderer> frames_;
    bool drawn_ = false;
};

// Whole frames for time_interleaved(). `frames` must not move in memory.
inline std::vector<study::TimedFrame> timed(std::vector<MeshFrame>& frames) {
    std::vector<study::TimedFrame> all;
    for (MeshFrame& frame : frames) {
        all.push_back({frame.name(), [&frame] { frame.warm_up(); }, [&frame] { frame.draw(); }});
    }
    return all;
}

}  // namespace lamina::papers

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/pipeline.h"
#include "study/interleaved_times.h"
#include "study/traced_mesh.h"

namespace lamina::papers {

// A scene of a mesh, prepared to be drawn again and again. The context must outlive it.
class MeshFrame {
  public:
    MeshFrame(std::string name, const study::TracedMesh& mesh, const Scene& scene,
              const Capabilities& capabilities, std::shared_ptr<TableCache> tables)
        : name_(std::move(name)),
          pipeline_(std::make_unique<Pipeline>(
              scene, mesh.data(),
              PipelineOptions{.capabilities = capabilities, .tables = std::move(tables)})) {
        pipeline_->set_up();
    }

    const std::string& name() const { return name_; }
    // Durations of the last frame's stages.
    std::map<std::string, double> stages_ms() const {
        return pipeline_->renderer().renderer().stages_ms();
    }
    std::int64_t tets_drawn() const { return pipeline_->statistics().tets_drawn; }
    Image picture() const { return pipeline_->renderer().picture(); }
    // Draws a whole frame: order, geometry and fragments.
    void draw() {
        pipeline_->draw_frame();
        drawn_ = true;
    }
    void warm_up() {
        if (!drawn_) draw();
    }

  private:
    std::string name_;
    std::unique_ptr<Pipeline> pipeline_;
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

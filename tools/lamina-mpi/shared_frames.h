// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "parallel/leader.h"
#include "render/pipeline.h"

namespace lamina {

// Throws Error if ranks cannot draw the scene together, UsageError if --context is not cpu.
void check_shared(const Scene& scene, const Auto<ContextChoice>& context);

// Frames that all ranks draw together; rank 0 has the pictures. `leader` must outlive the object.
class SharedFrames : public Frames {
  public:
    SharedFrames(Leader& leader, const Scene& scene, SceneData& data,
                 const PipelineOptions& options);
    ~SharedFrames() override;

    const Scene& scene() const override { return scene_; }
    void set_scene(Scene scene) override;  // opens the scene on all ranks, closes the old one
    void set_camera(const Camera& camera) override {
        scene_.camera = camera;
        camera_ = camera;
    }

    const Resolved& resolved() override { return own().renderer().resolved(); }
    const Plan& plan() override { return own().plan(); }
    std::string explanation() override { return own().renderer().explanation(); }
    Warnings warnings() override { return own().renderer().warnings(); }
    void set_up() override {}  // opening the scene has set it up
    void draw(std::stop_token stop = {}) override;
    void read(Image& picture) const override;
    void add_to(FrameStatistics& statistics) override;

  private:
    Pipeline& own() const { return leader_.renderer(number_).own(); }

    Leader& leader_;
    Scene scene_;
    SceneData data_;
    OmissionSwitch omissions_;
    bool many_frames_;
    int number_;                    // Leader's number of the open scene
    std::optional<Camera> camera_;  // empty until set_camera(): the scene's camera
};

// Returns the reports as JSON for --stats.
nlohmann::ordered_json to_json(const std::vector<RankReport>& reports);

}  // namespace lamina

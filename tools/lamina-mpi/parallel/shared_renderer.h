// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lamina/image.h"
#include "parallel/picture_composer.h"
#include "render/pipeline.h"

namespace lamina {

// A frame's times, memory and traffic on one rank. Ranks send it as bytes.
struct RankReport {
    std::array<char, 64> machine{};  // its name, zero-terminated
    std::int32_t threads = 0;
    double draw_ms = 0;       // time to plan and draw the rank's share
    double composite_ms = 0;  // time to composite, waiting for other ranks included
    std::int64_t segments = 0;
    std::int64_t bytes_sent = 0, messages_sent = 0;
    std::int64_t peak_memory = 0;  // largest resident size since the start, bytes
};

// Draws one share of a scene's volume and composites it with the shares of the other ranks. Every
// rank has a renderer of the same scene, and all call draw() together.
class SharedRenderer {
  public:
    // Throws Error if the scene has a setting that ranks cannot share. Its method must be `slice`.
    // `ranks` must outlive the renderer. `many_frames`, `tables`: as in PipelineOptions.
    SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene, SceneData data,
                   const OmissionSwitch& omissions, bool many_frames,
                   std::shared_ptr<TableCache> tables);

    // The pipeline that draws this rank's share.
    Pipeline& own() { return own_; }

    // Measures the data, plans and makes the renderer: each rank by itself, all at the same time.
    void set_up() { own_.set_up(); }
    // Throws Error on all ranks if their plans differ.
    void check_plan();

    // Draws a frame, with another camera or as before. Rank 0 then has the picture and the reports
    // of all ranks.
    void draw(const std::optional<Camera>& camera);
    const Image& picture() const { return picture_; }
    const std::vector<RankReport>& reports() const { return reports_; }

  private:
    const Ranks& ranks_;
    Pipeline own_;
    PictureComposer composer_;
    Image picture_;
    std::vector<RankReport> reports_;
};

}  // namespace lamina

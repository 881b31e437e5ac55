// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lamina/image.h"
#include "parallel/picture_composer.h"
#include "parallel/rank_report.h"
#include "render/pipeline.h"

namespace lamina {

// Draws one scene's volume together with the other ranks, each its share. All ranks have one, of
// the same scene, and call draw() together.
class SharedRenderer {
  public:
    // `scene`: of method slice. `ranks` must outlive it. `many_frames`, `tables`: as in
    // PipelineOptions.
    // Throws Error if the scene asks for what ranks cannot share, and says what.
    SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene, SceneData data,
                   const OmissionSwitch& omissions, bool many_frames,
                   std::shared_ptr<TableCache> tables);

    // This rank's part of the work.
    Pipeline& own() { return own_; }

    // Measures the data, plans and makes the renderer. Each rank does so by itself, at the same
    // time.
    void set_up() { own_.set_up(); }
    // Throws Error on all ranks where their plans differ.
    void check_plan();

    // Draws a frame, with another camera or as before; rank 0 then has the picture, and what it
    // took on all ranks.
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

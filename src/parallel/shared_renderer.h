// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lamina/image.h"
#include "parallel/picture_composer.h"
#include "parallel/rank_report.h"
#include "render/scene_renderer.h"

namespace lamina {

// Draws one scene's volume together with the other ranks, each its share. All ranks have one, of
// the same scene, and call draw() together.
class SharedRenderer {
  public:
    // `scene`: of method slice. `ranks` must outlive it.
    // Throws Error where the scene asks for what ranks cannot share, and says what.
    SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene,
                   std::shared_ptr<const VolumeData> volume, const OmissionSwitch& omissions);

    // This rank's part of the work.
    SceneRenderer& own() { return own_; }

    // Measures the data, plans and makes the renderer. Each rank does so by itself, at the same
    // time. `many_frames`: SceneRenderer::expect_many_frames().
    void set_up(bool many_frames);
    // Throws Error on all ranks where their plans differ.
    void check_plan();

    // Draws a frame, with another camera or as before; rank 0 then has the picture, and what it
    // took on all ranks.
    void draw(const std::optional<Camera>& camera);
    const Image& picture() const { return picture_; }
    const std::vector<RankReport>& reports() const { return reports_; }

  private:
    const Ranks& ranks_;
    SceneRenderer own_;
    PictureComposer composer_;
    Image picture_;
    std::vector<RankReport> reports_;
};

}  // namespace lamina

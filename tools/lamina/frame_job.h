// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/draw_context.h"
#include "render/scene_renderer.h"
#include "render_job.h"

namespace lamina {

// What a method brings along to draw frames. Called in this order.
class FrameMethod {
  public:
    virtual ~FrameMethod() = default;
    virtual std::unique_ptr<SceneRenderer> open(const Capabilities& capabilities) = 0;
    // Says and counts what is noteworthy of the data and of the plan.
    virtual void report_plan(const Plan& plan, RenderStats& stats) = 0;
    // What the statistics want to know of the scene's own frame, beside its stages.
    virtual void report_frame(const Plan& plan, const FrameRenderer& renderer,
                              RenderStats& stats) const = 0;
};

// Draws frames with a SceneRenderer.
class FrameJob : public RenderJob {
  public:
    FrameJob(const RenderRequest& request, std::unique_ptr<FrameMethod> method);

    Plan plan(RenderStats& stats) override;
    Scene resolved_scene() override { return frames_->resolved_scene(); }
    std::string explanation(const Plan& plan) const override;
    void draw(const Plan& plan, RenderStats& stats) override;
    void draw_frame(const Camera& camera) override;
    void draw_view(const Camera& camera, const Plan& plan, RenderStats& stats) override;
    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override;

  private:
    void draw_first(RenderStats& stats);

    const RenderRequest request_;
    std::unique_ptr<FrameMethod> method_;
    std::optional<DrawContext> context_;
    std::unique_ptr<gl::CurrentContext> current_;
    std::unique_ptr<SceneRenderer> frames_;
    std::optional<Image> image_;
};

}  // namespace lamina

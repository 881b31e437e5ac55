// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render_job.h"
#include "scene/frame_renderer.h"
#include "study/draw_context.h"

namespace lamina {

// What a method brings along to draw frames. Called in this order.
class FrameMethod {
  public:
    virtual ~FrameMethod() = default;
    virtual const char* activity() const = 0;  // in front of the progress bar
    // Loads and measures what is drawn.
    virtual void load(RenderStats& stats) = 0;
    virtual Plan plan(const Capabilities& capabilities) = 0;
    virtual std::string explanation(const Plan& plan, const Capabilities& capabilities) const = 0;
    // What is loaded outlives the renderer.
    virtual std::unique_ptr<FrameRenderer> make_renderer(const Plan& plan,
                                                         const Capabilities& capabilities) = 0;
    // What the statistics want to know of the scene's own frame, beside its stages.
    virtual void report(RenderStats& stats) const = 0;
};

// Draws frames with a renderer.
class FrameJob : public RenderJob {
  public:
    FrameJob(const RenderRequest& request, std::unique_ptr<FrameMethod> method);

    Plan plan(RenderStats& stats) override;
    std::string explanation(const Plan& plan) const override;
    void draw(const Plan& plan, const View& view, RenderStats& stats) override;
    void draw_frame(const View& view) override;
    std::size_t write(PictureFile& picture, const PictureAttributes& attributes) override;

  private:
    void draw_first(const View& view, RenderStats& stats);

    const RenderRequest request_;
    std::unique_ptr<FrameMethod> method_;
    std::optional<DrawContext> context_;
    std::unique_ptr<FrameRenderer> renderer_;
    std::optional<Image> image_;
};

}  // namespace lamina

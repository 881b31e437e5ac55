// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "frame_job.h"

namespace lamina {
namespace {

class SliceMethod : public FrameMethod {
  public:
    explicit SliceMethod(const RenderRequest& request) : request_(request) {}

    std::unique_ptr<SceneRenderer> open(const Capabilities& capabilities) override {
        auto renderer = std::make_unique<SceneRenderer>(request_.scene, request_.data.volume,
                                                        capabilities, request_.omissions);
        if (request_.many_frames) renderer->expect_many_frames();
        return renderer;
    }

    void report_plan(const Plan& /*plan*/, RenderStats& stats) override {
        stats.counts["non_finite_samples"] = request_.data.volume->bricks.non_finite;
    }

    void report_frame(const Plan& plan, const FrameRenderer& /*renderer*/,
                      RenderStats& stats) const override {
        stats.samples = plan.slice.slabs;
    }

  private:
    const RenderRequest request_;
};

}  // namespace

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<SliceMethod>(request));
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "frame_job.h"
#include "loaded_volume.h"

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

    void report_plan(const Plan& plan, RenderStats& stats) override {
        report_volume(request_, *request_.data.volume, stats);
        say_what_is_not_kept(plan.slice);
    }

    void report_frame(const Plan& plan, const FrameRenderer& /*renderer*/,
                      RenderStats& stats) const override {
        stats.samples = plan.slice.slabs;
    }

  private:
    void say_what_is_not_kept(const SlicePlan& plan) const {
        const double wanted = request_.scene.max_error;
        const double error = plan.found_error() + plan.error_bound.value_or(0);
        const auto& trial = plan.slab_trial;
        if (error > wanted) {
            const std::string why =
                plan.integrates_cells()
                    ? fmt::format("exact segments in {} are off by up to {:.2g} / 255",
                                  name_of(plan.target), error)
                : plan.table.error > wanted
                    ? fmt::format(
                          "the pre-integration table is off by up to {:.2g} / 255 "
                          "(render.slice.classification \"post\" does without)",
                          plan.table.error)
                : trial
                    ? fmt::format(
                          "of the numbers of slabs that were tried, {} are taken, with an error "
                          "of {:.2g} / 255 (render.slice.samples sets another)",
                          plan.slabs, error)
                    : fmt::format("{} slabs composited in {} are off by up to {:.2g} / 255",
                                  plan.slabs, name_of(plan.target), error);
            request_.message(fmt::format("render.max_error: {:.4g} is not kept: {}", wanted, why));
        } else if (trial && trial->doubtful) {
            request_.message(
                fmt::format("render.max_error: {:.4g} is not sure to be kept: {} slabs are off by "
                            "{:.2g} / 255 on {} traced rays of {}, and others may be off by more",
                            wanted, plan.slabs, error, trial->traced, trial->rays));
        }
    }

    const RenderRequest request_;
};

}  // namespace

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<SliceMethod>(request));
}

}  // namespace lamina

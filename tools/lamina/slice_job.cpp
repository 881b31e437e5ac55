// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "frame_job.h"
#include "loaded_volume.h"
#include "slicing/slab_trials.h"
#include "slicing/slice_renderer.h"

namespace lamina {
namespace {

class SliceMethod : public FrameMethod {
  public:
    explicit SliceMethod(const RenderRequest& request) : request_(request) {}

    const char* activity() const override { return "slicing"; }

    void load(RenderStats& stats) override { data_.emplace(request_, stats); }

    Plan plan(const Capabilities& capabilities) override {
        try_filter(request_.scene, data_->volume, capabilities, data_->facts);
        Plan plan = make_plan(request_.scene, data_->facts, capabilities, request_.omissions);
        say_what_is_not_kept(plan.slice);
        return plan;
    }

    std::string explanation(const Plan& plan, const Capabilities& capabilities) const override {
        return explain(plan, data_->facts, capabilities);
    }

    std::unique_ptr<FrameRenderer> make_renderer(const Plan& plan,
                                                 const Capabilities& capabilities) override {
        const Scene& scene = request_.scene;
        slabs_ = plan.slice.slabs;
        return make_slice_renderer(data_->volume, scene.transfer_function, data_->facts, plan.slice,
                                   capabilities, scene.width, scene.height);
    }

    void report(RenderStats& stats) const override { stats.samples = slabs_; }

  private:
    void say_what_is_not_kept(const SlicePlan& plan) const {
        const double wanted = request_.scene.max_error;
        if (!plan.slab_trial) {
            if (plan.table.error > wanted) {
                request_.message(fmt::format(
                    "render.max_error: found {:.4g}, not kept: the pre-integration table is off by "
                    "{:.2g} (render.slice.classification \"post\" does without)",
                    wanted, plan.table.error));
            }
            return;
        }
        const SlabTrial& trial = *plan.slab_trial;
        const double error = trial.error + plan.error_bound.value_or(0);
        if (error > wanted) {
            request_.message(fmt::format(
                "render.max_error: found {:.4g}, not kept: of the numbers of slabs that were "
                "tried, {} are taken, with an error of {:.2g} (render.slice.samples sets another)",
                wanted, trial.slabs, error));
        } else if (trial.doubtful) {
            request_.message(fmt::format(
                "render.max_error: found {:.4g}, not sure to be kept: {} slabs are off by {:.2g} "
                "on {} traced rays of {}, and others may be off by more",
                wanted, trial.slabs, error, trial.traced, trial.rays));
        }
    }

    const RenderRequest request_;
    std::optional<LoadedVolume> data_;
    int slabs_ = 0;
};

}  // namespace

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<SliceMethod>(request));
}

}  // namespace lamina

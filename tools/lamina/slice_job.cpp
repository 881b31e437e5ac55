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
        const double error = plan.found_error() + plan.error_bound.value_or(0);
        const auto& trial = plan.slab_trial;
        if (error > wanted) {
            const std::string why =
                plan.table.error > wanted
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
    std::optional<LoadedVolume> data_;
    int slabs_ = 0;
};

}  // namespace

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<SliceMethod>(request));
}

}  // namespace lamina

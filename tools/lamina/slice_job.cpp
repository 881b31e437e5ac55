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
        const SlicePlan& slice = plan.slice;
        const double found = slice.slab_trial ? slice.slab_trial->error : slice.filter_error;
        const double error = found + slice.error_bound.value_or(0);
        if (error <= request_.scene.max_error) return plan;
        const std::string why =
            slice.slab_trial
                ? fmt::format(
                      "of the numbers of slabs that were tried, {} are taken, with an "
                      "error of {:.2g} / 255 (render.slice.samples sets another)",
                      slice.slabs, error)
                : fmt::format("{} slabs composited in {} are off by up to {:.2g} / 255",
                              slice.slabs, name_of(slice.target), error);
        request_.message(
            fmt::format("render.max_error: {:.4g} is not kept: {}", request_.scene.max_error, why));
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
    const RenderRequest request_;
    std::optional<LoadedVolume> data_;
    int slabs_ = 0;
};

}  // namespace

std::unique_ptr<RenderJob> make_slice_job(const RenderRequest& request) {
    return std::make_unique<FrameJob>(request, std::make_unique<SliceMethod>(request));
}

}  // namespace lamina

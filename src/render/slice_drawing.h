// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "plan/slab_choice.h"
#include "plan/volume_shares.h"
#include "render/drawing.h"
#include "render/picture_share.h"
#include "slicing/slice_renderer.h"
#include "volume/volume_data.h"

namespace lamina {

class SliceDrawing : public Drawing {
  public:
    SliceDrawing(std::shared_ptr<const VolumeData> data, const PictureShare& share,
                 std::shared_ptr<TableCache> tables)
        : data_(std::move(data)), share_(share), tables_(std::move(tables)) {}

    const char* activity() const override { return "slicing"; }
    void measure_data(const Scene& scene) override;
    void measure_view(const Scene& scene, const Plan* planned) override;
    void make_trials(const Scene& scene, const Capabilities& capabilities,
                     bool many_frames) override;
    Plan plan(const Scene& scene, const Capabilities& capabilities, const OmissionSwitch& omissions,
              bool for_people) const override;
    Resolved resolve(Scene scene, const Plan& plan) const override;
    std::string explanation(const Plan& plan, const Capabilities& capabilities) const override;
    Warnings warnings(const Resolved& resolved, const Plan& plan) override;
    void make_renderer(const Resolved& resolved, const Plan& plan,
                       const Capabilities& capabilities) override;
    FrameRenderer* renderer() const override { return renderer_.get(); }

    std::vector<IndexBox> shares() const override;
    std::vector<int> front_to_back(const Scene& scene) const override;

  private:
    std::shared_ptr<const VolumeData> data_;
    PictureShare share_;
    std::shared_ptr<TableCache> tables_;
    std::optional<VolumeShares> shares_;
    Facts facts_;
    SampleTrials trials_;
    std::unique_ptr<SliceRenderer> renderer_;
};

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "papers/paper_hardware.h"
#include "render/pipeline.h"

namespace lamina::papers {

// The mixing liquids, exact (float32) and as the paper's hardware dithers them.
struct DitheredMixing {
    Scene scene;  // scene of the exact picture
    Image exact;
    std::vector<int> periods;  // 1 stands for no dithering
    std::vector<Image> dithered;
};

// A stage has the current context, the pre-integration tables and the pictures that several of the
// items share.
class LamarStage {
  public:
    // Pictures of the mixing liquids have `pixels` x `pixels` pixels.
    explicit LamarStage(const Capabilities& capabilities, int pixels = 160)
        : capabilities_(capabilities), pixels_(pixels) {}

    const Capabilities& capabilities() const { return capabilities_; }
    int pixels() const { return pixels_; }
    const std::shared_ptr<TableCache>& tables() const { return tables_; }
    Image draw_mixing(const Scene& scene);    // the volume is made when first needed
    const DitheredMixing& dithered_mixing();  // for Table 4 and Figure 6; made when first needed

  private:
    Capabilities capabilities_;
    int pixels_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    std::shared_ptr<const VolumeData> mixing_;
    std::optional<DitheredMixing> dithered_mixing_;
};

}  // namespace lamina::papers

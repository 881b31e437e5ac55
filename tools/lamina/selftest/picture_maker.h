// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "preintegration/table_cache.h"
#include "render/scene_data.h"

namespace lamina::selftest {

// Draws as `lamina render` does. Virtual for checks of the self-test itself, which must find what a
// wrong renderer draws.
class PictureMaker {
  public:
    explicit PictureMaker(const Capabilities& capabilities) : capabilities_(capabilities) {}
    virtual ~PictureMaker() = default;

    // `statistics`: gets those of the picture, if it is not null.
    virtual PreciseImage draw(const Scene& scene, const SceneData& data,
                              FrameStatistics* statistics = nullptr) const;

  private:
    const Capabilities& capabilities_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
};

}  // namespace lamina::selftest

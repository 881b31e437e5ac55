// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "mesh/visibility_order.h"
#include "scene/frame_renderer.h"

namespace lamina {

// Draws frames of a mesh. Both are of the last one.
class ProjectRenderer : public FrameRenderer {
  public:
    virtual const OrderReport& order_report() const = 0;
    virtual std::int64_t tets_drawn() const = 0;  // that cover the centre of a pixel
};

}  // namespace lamina

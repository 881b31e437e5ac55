// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "plan/compositing_plan.h"

namespace lamina {

// The plan's choices for compositing fragments onto the pixels of a tile, in the form that the
// inner loops of tiles/target_pixels-inl.h use.
struct TargetBlend {
    Target target = Target::float32;
    int bits = 8;       // bits of a code, for targets with codes
    float largest = 1;  // value that stands for 1 in the tiles: the largest code, or 1
    Order order = Order::back_to_front;
    AlphaRounding alpha_rounding = AlphaRounding::truncate;
    OverRounding over_rounding = OverRounding::separate;
    std::uint32_t seed = 1;  // of stochastic rounding
};

TargetBlend target_blend(const CompositingPlan& plan);

}  // namespace lamina

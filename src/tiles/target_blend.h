// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "plan/compositing_plan.h"

namespace lamina {

// How fragments reach the pixels of a tile: what a plan says of its target, in the form that the
// inner loops of tiles/target_pixels-inl.h want.
struct TargetBlend {
    Target target = Target::float32;
    int bits = 8;       // of a code, where there are codes
    float largest = 1;  // what stands for 1 in the tiles: the largest code, or 1
    Order order = Order::back_to_front;
    AlphaRounding alpha_rounding = AlphaRounding::truncate;
    OverRounding over_rounding = OverRounding::separate;
    std::uint32_t seed = 1;  // of stochastic rounding
};

TargetBlend target_blend(const CompositingPlan& plan);

}  // namespace lamina

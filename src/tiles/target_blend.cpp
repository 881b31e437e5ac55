// SPDX-License-Identifier: Apache-2.0
#include "tiles/target_blend.h"

#include "compositing/codes.h"

namespace lamina {

TargetBlend target_blend(const CompositingPlan& plan) {
    TargetBlend blend;
    blend.target = plan.target;
    blend.bits = plan.code_bits();
    if (is_fixed_point(plan.target)) blend.largest = static_cast<float>(largest_code(blend.bits));
    blend.order = plan.order;
    if (plan.emulation) {
        blend.alpha_rounding = plan.emulation->alpha;
        blend.over_rounding = plan.emulation->over;
        blend.seed = plan.emulation->seed;
    }
    return blend;
}

}  // namespace lamina

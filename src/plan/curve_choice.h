// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "facts/facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/plan.h"

namespace lamina {

// Curves in place of straight pieces of the transfer function (optics/curved_pieces.h).
struct CurveChoice {
    bool pay = false;
    double error = 0;  // at most, in 1/255
    std::string reason;
};

// Whether exact segments of this plan follow curves. They do not where no point of the transfer
// function is smooth, or max_error is too small.
CurveChoice choose_curves(const Scene& scene, const Facts& facts, const SlicePlan& slice,
                          const Capabilities& capabilities);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan.h"

namespace lamina {

// make_plan() for Method::slice with a target by name; says nothing of what omissions save.
Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials = {});

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan.h"

namespace lamina {

// Makes the plan for Method::slice with a given target and classification (not "auto"). It does not
// compute what omissions save.
Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan.h"

namespace lamina {

// Makes the plan for Method::slice with a given target and classification (not "auto"). It does not
// compute what omissions save. Its table is built if its error was measured.
Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables);

// Builds the table of a plan that is going to be drawn, if it has one that was not measured.
void build_drawn_table(const Scene& scene, const Facts& facts, SlicePlan& plan, TableCache& tables);

}  // namespace lamina

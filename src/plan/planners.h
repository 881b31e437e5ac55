// SPDX-License-Identifier: Apache-2.0
// The planners of the two methods, for scenes whose target and classification are not automatic.
#pragma once

#include "plan/plan.h"

namespace lamina {

// Makes the plan for Method::slice, without the work that omissions save. Its table is built if its
// error was measured.
Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables);

// Builds the table of a plan that is going to be drawn, if it has one that was not measured.
void build_drawn_table(const Scene& scene, const Facts& facts, SlicePlan& plan, TableCache& tables);

// Makes the plan for Method::project, without the work that omissions save. Pre-integration tables
// are built to measure their error.
Plan plan_projection(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
                     const OmissionSwitch& omissions, TableCache& tables);

}  // namespace lamina

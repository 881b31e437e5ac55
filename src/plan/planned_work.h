// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan.h"

namespace lamina {

// What a frame of a plan takes.
Work planned_work(const SlicePlan& plan, const Facts& facts, const Scene& scene, bool tiles);
Work planned_work(const ProjectPlan& plan, const MeshFacts& facts, const Scene& scene);

// What each omission of a plan saves: the work of the plan without it, less that of the plan.
void add_savings(Plan& plan, const Scene& scene, const Facts& facts,
                 const Capabilities& capabilities, const OmissionSwitch& omissions,
                 const SampleTrials& trials = {});
void add_savings(Plan& plan, const Scene& scene, const MeshFacts& facts);

}  // namespace lamina

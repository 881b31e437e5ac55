// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/plan.h"

namespace lamina {

// Predicts the work of a frame.
Work planned_work(const SlicePlan& plan, const Facts& facts, const Scene& scene, bool tiles);
Work planned_work(const ProjectPlan& plan, const MeshFacts& facts, const Scene& scene);

// Sets the work that each omission saves: the work of a plan without it minus the work of this
// plan.
void add_savings(Plan& plan, const Scene& scene, const Facts& facts,
                 const Capabilities& capabilities, const OmissionSwitch& omissions,
                 const SampleTrials& trials, TableCache& tables);
void add_savings(Plan& plan, const Scene& scene, const MeshFacts& facts);

}  // namespace lamina

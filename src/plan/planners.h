// SPDX-License-Identifier: Apache-2.0
// The planners of the two methods, for scenes whose target and classification are not automatic.
#pragma once

#include "plan/plan.h"

namespace lamina {

// Makes the plan for Method::slice, except for Plan::work and Omission::saves. Its table is built
// only if its error was measured.
Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables);

// Builds the table of a plan that is going to be drawn, if the plan has one that is not built yet.
void build_drawn_table(const Scene& scene, const Facts& facts, SlicePlan& plan, TableCache& tables);

// Makes the plan for Method::project, except for Plan::work and Omission::saves. Pre-integration
// tables are built to measure their error.
Plan plan_projection(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
                     const OmissionSwitch& omissions, TableCache& tables);

// Cuts the volume into bricks that respect the context's limits: cuts are added along the longest
// edge of a brick until all bricks fit. `bordered`: one more sample at both ends of each `cell`
// axis repeats the border, so that no other sample, which may be NaN, is read there with a weight
// of 0. Throws Error if even two samples along an axis are too many.
std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities);

// Predicts the work of a frame. `tiles`: the cpu engine draws.
Work planned_work(const SlicePlan& plan, const Facts& facts, const Scene& scene, bool tiles);
Work planned_work(const ProjectPlan& plan, const MeshFacts& facts, const Scene& scene);

// Sets what work each omission saves: that of a plan without it minus that of this plan.
void add_savings(Plan& plan, const Scene& scene, const Facts& facts,
                 const Capabilities& capabilities, const OmissionSwitch& omissions,
                 const SampleTrials& trials, TableCache& tables);
void add_savings(Plan& plan, const Scene& scene, const MeshFacts& facts);

}  // namespace lamina

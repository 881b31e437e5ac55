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

// Cuts the volume into the fewest bricks that respect the context's limits: the longest edge is cut
// once more until all fit. `bordered`: one more sample at both ends of each `cell` axis repeats the
// border, so that no other sample, which may be NaN, is read there with a weight of 0. Throws Error
// if even two samples along an axis are too many.
std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities);

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

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "facts/facts.h"
#include "lamina/scene.h"
#include "plan/sample_trials.h"

namespace lamina {

// The number of slabs, 1 .. max_slabs, that makes `slabs` slabs per voxel along the view.
int slabs_per_voxel(const Facts& facts, double slabs);

// The largest error, in 1/255, that a trial of an automatic number of slabs may find. Automatic
// compositing takes its share of max_error first. The goal is stricter where only `rays` of the
// picture's rays were tried, because the largest error of all rays is then larger than the one
// found. `max_color` and `slabs` matter where the target is automatic, too.
double slab_error_goal(const Scene& scene, double max_color, int slabs, double rays);

// Whether the errors fall with about the second power of the number of slabs, as for smooth
// pictures. Otherwise fewer slabs may by chance have a smaller error than more.
bool are_of_second_order(std::vector<SlabTrial> trials);

// The choice of "samples": "auto". It is the fewest slabs whose trial keeps its goal. Where none
// does, it is the fewest slabs, of two a voxel or more, whose error is near the least. Where
// nothing was tried, it is two slabs a voxel, with an unknown error (NaN).
SlabTrial chosen_slabs(const Facts& facts, const SampleTrials& trials);

// The choice of "filter": "auto": the fewest slabs whose trial with the weights of texture units
// keeps its goal, if any does.
std::optional<SlabTrial> slabs_of_hardware_filter(const SampleTrials& trials);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "facts/facts.h"
#include "lamina/scene.h"
#include "plan/sample_trials.h"

namespace lamina {

// So many slabs a voxel along the view, 1 .. max_slabs.
int slabs_per_voxel(const Facts& facts, double slabs);

// What so many slabs may be found to add to the picture's error where their number is automatic, in
// 1/255: what compositing that is automatic, too, leaves of max_error, and less the fewer of the
// picture's rays are tried. `max_color` and `slabs` matter where the target is automatic.
double slab_error_goal(const Scene& scene, double max_color, int slabs, double rays);

// Whether the errors of trials fall as those of smooth pictures do: some two orders with the number
// of slabs. Else fewer slabs may by chance be nearer to the truth than more.
bool are_of_second_order(std::vector<SlabTrial> trials);

// "samples": "auto": of what was tried the fewest slabs that keep their goal; where none does, of
// two a voxel and more the fewest whose error is near the least. Where nothing was tried, two a
// voxel, of an error that is not known (NaN).
SlabTrial chosen_slabs(const Facts& facts, const SampleTrials& trials);

// "filter": "auto": of what was tried with the weights of texture units the fewest slabs that keep
// their goal, if any do.
std::optional<SlabTrial> slabs_of_hardware_filter(const SampleTrials& trials);

}  // namespace lamina

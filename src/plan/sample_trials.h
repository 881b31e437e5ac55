// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "plan/slab_trial.h"

namespace lamina {

// Numbers of slabs that were tried where the scene says "auto" (slicing/slab_trials.h tries them).
struct SampleTrials {
    // For "samples": "auto"; else none.
    std::vector<SlabTrial> exact;
    // For "filter": "auto": with weights rounded to 8 bits, as texture units have them. Where the
    // number of slabs was given, the error is that of the weights alone.
    std::vector<SlabTrial> hardware;
};

}  // namespace lamina

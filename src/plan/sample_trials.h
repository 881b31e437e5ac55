// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "plan/slab_trial.h"

namespace lamina {

// Numbers of slabs that were tried, where the scene has "auto" (slicing/slab_trials.h tries them).
struct SampleTrials {
    // For "samples": "auto"; otherwise empty.
    std::vector<SlabTrial> exact;
    // For "filter": "auto", with filter weights rounded to 8 bits as in texture units. Where the
    // number of slabs was given, the error is that of the weights alone.
    std::vector<SlabTrial> hardware;
};

}  // namespace lamina

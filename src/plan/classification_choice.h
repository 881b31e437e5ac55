// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/slab_choice.h"

namespace lamina {

// Largest error of exact segments in float32, in 1/255, of colours up to 1, if extinction times the
// length of a cell jumps by less than .2 (docs/precision.md, "Exact segments").
inline constexpr double exact_segment_error = 0.05;

struct ClassificationChoice {
    Classification classification = Classification::post;  // not automatic
    int slabs = 1;       // for exact segments if the scene names none (plan/march_limit.h)
    std::string reason;  // empty if the scene names the classification
};

// Makes the choice of "classification": "auto" for slicing: exact segments, unless the context's
// loops are too short for them or `trials` found few enough slabs that are quicker
// (slicing/slab_trials.h). Throws Error if the filter or the number of slabs cannot do what the
// scene asks for.
ClassificationChoice choose_classification(const Scene& scene, const Facts& facts,
                                           const Capabilities& capabilities,
                                           const SampleTrials& trials = {});

// Largest number of post-classified slabs a voxel that take less of a frame than exact segments:
// measured, these take as long as 2.7 or more (docs/precision.md).
inline constexpr double quicker_slabs_per_voxel = 2;

// Tells whether trials may find slabs that are quicker than the exact segments which "auto"
// chooses: not for targets whose error grows with the number of slabs.
bool may_be_quicker(const Scene& scene);

// Gives the scene a classification and a number of slabs: that of the tree or of the choice,
// because with exact segments all numbers are equally good.
Scene with_classification(Scene scene, const ClassificationChoice& choice);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "facts/facts.h"
#include "lamina/scene.h"
#include "plan/sample_trials.h"

namespace lamina {

// Of max_error, what a target that is chosen may use up: so little that slabs need hardly be more
// (their error falls with their number squared).
inline constexpr double target_share = 0.15;

struct TargetChoice {
    Target target = Target::float32;
    std::string reason;  // empty: as the scene asks
    double error = 0;    // at most, in 1/255: 0 where no bound is known or needed
};

// "target": "auto", of slicing: the fewest bytes a pixel with which compositing keeps its share of
// max_error.
TargetChoice choose_target(const Scene& scene, const Facts& facts, const SampleTrials& trials);
TargetChoice choose_target(const Scene& scene, double max_color, int slabs);
// Of projected tetrahedra.
TargetChoice choose_project_target(const Scene& scene);

// The scene as if it had asked for the target; where that was chosen for slicing without a tree and
// is smaller than float32, with a tree, so that the bound of the choice is kept.
Scene with_target(Scene scene, Target target);

}  // namespace lamina

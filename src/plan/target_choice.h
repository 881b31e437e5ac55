// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "plan/slab_choice.h"

namespace lamina {

// Share of max_error by which an automatic target may round. It is small, so that the remaining
// bound hardly needs more slabs (their error falls with the square of their number).
inline constexpr double target_share = 0.15;

struct TargetChoice {
    Target target = Target::float32;
    std::string reason;  // empty if the scene names the target
    double error = 0;    // bound on its rounding, in 1/255; 0 if no bound is known or needed
};

// Makes the choice of "target": "auto" for slicing: the target with the fewest bytes a pixel whose
// compositing error is within target_share of max_error.
TargetChoice choose_target(const Scene& scene, const Facts& facts, const SampleTrials& trials);
TargetChoice choose_target(const Scene& scene, double max_color, int slabs);
// Chooses the target of projected tetrahedra.
TargetChoice choose_project_target(const Scene& scene);

// Gives the scene a target. If a target smaller than float32 was chosen for slicing without a tree,
// the scene also gets a tree, because the bound of the choice is the bound of a tree.
Scene with_target(Scene scene, Target target);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "plan/plan.h"
#include "plan/project_plan.h"

namespace lamina {

// Sets what the plan of a lit scene says of light; `max_color`: of the unlit picture.
void plan_light(const Scene& scene, double max_color, SlicePlan& slice);
void plan_light(const Scene& scene, double max_color, ProjectPlan& project);

// The most rounds of loops that a fragment of OpenGL takes, beyond those of unlit scenes, to cut
// its ray where light bends.
double light_rounds(const Scene& scene, double max_color);

// The largest component that the scene may draw.
double largest_drawn_color(const Scene& scene, double max_color);

}  // namespace lamina

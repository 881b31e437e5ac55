// SPDX-License-Identifier: Apache-2.0
#include "plan/light_choice.h"

#include <algorithm>

#include "optics/ray_lights.h"

namespace lamina {
namespace {

// Of max_error, what kinks and bends may cost; and what light may be off by in all, with the parts
// that are too faint to be looked at.
constexpr double bend_share = 0.5, light_share = 0.75;
// Of what it sees light bend, what the rule of three nodes misses of a kink between them.
constexpr double missed_of_kink = 0.045;

// A ray's opacity is at most 1: where each of its pieces misses no more than this of what it shows,
// the ray does not either.
template <typename MethodPlan>
void set_light(const Scene& scene, double max_color, MethodPlan& plan) {
    if (!scene.lighting) return;
    plan.lighting = scene.lighting;
    plan.light_error = light_share * scene.max_error;
    plan.most_bend = bend_share * scene.max_error / 255 / missed_of_kink / std::max(max_color, 1.0);
}

}  // namespace

void plan_light(const Scene& scene, double max_color, SlicePlan& slice) {
    set_light(scene, max_color, slice);
}

void plan_light(const Scene& scene, double max_color, ProjectPlan& project) {
    set_light(scene, max_color, project);
}

double largest_drawn_color(const Scene& scene, double max_color) {
    if (!scene.lighting) return max_color;
    const glm::dvec3 anywhere(0, 0, 1);
    return RayLights(*scene.lighting, anywhere).brightest_lit(max_color);
}

}  // namespace lamina

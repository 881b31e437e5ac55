// SPDX-License-Identifier: Apache-2.0
#include "plan/light_choice.h"

#include <algorithm>

#include "optics/ray_lights.h"

namespace lamina {
namespace {

// Shares of max_error: what kinks and bends may cost, and what light may cost in all, with the
// pieces that are too faint to be looked at.
constexpr double bend_share = 0.5, light_share = 0.75;
// Share of a bend that the rule of three nodes misses of a kink between them (docs/numerics.md,
// section 10.4).
constexpr double missed_of_kink = 0.045;

// Returns the bend that a piece may have (docs/numerics.md, equation (10.4)). A ray's opacity is at
// most 1: if each of its pieces misses no more than its share of what it shows, so does the ray.
double most_bend(const Scene& scene, double max_color) {
    return bend_share * scene.max_error / 255 / missed_of_kink / std::max(max_color, 1.0);
}

template <typename MethodPlan>
void set_light(const Scene& scene, double max_color, MethodPlan& plan) {
    if (!scene.lighting) return;
    plan.lighting = scene.lighting;
    plan.light_error = light_share * scene.max_error;
    plan.most_bend = most_bend(scene, max_color);
}

}  // namespace

void plan_light(const Scene& scene, double max_color, SlicePlan& slice) {
    if (slice.classification == Classification::exact) {
        set_light(scene, max_color, slice);
    } else {
        slice.lighting = scene.lighting;
    }
}

void plan_light(const Scene& scene, double max_color, ProjectPlan& project) {
    set_light(scene, max_color, project);
}

// Returns the bound of docs/numerics.md, equation (10.6).
double light_rounds(const Scene& scene, double max_color) {
    if (!scene.lighting) return 0;
    const glm::dvec3 anywhere(0, 0, 1);
    const RayLights lights(*scene.lighting, anywhere);
    const double most = 4 * std::max(lights.largest_effect(1), 1.0) * 2.52 * lights.effect_span() /
                        most_bend(scene, max_color);
    return (3 * 8 + 10) * most;
}

double largest_drawn_color(const Scene& scene, double max_color) {
    if (!scene.lighting) return max_color;
    const glm::dvec3 anywhere(0, 0, 1);
    return RayLights(*scene.lighting, anywhere).brightest_lit(max_color);
}

}  // namespace lamina

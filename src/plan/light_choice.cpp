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

// A piece is tried again, half as long, only where light bends by more than `most_bend` and by more
// than a quarter of that in what the eye sees of it, divided by the largest effect of light where
// that is more than 1. The second difference of three effects is at most twice their span, which is
// at least what may be hidden; kinks count up to 2.52 times the span. So such a piece shows at
// least 1 / `most` of the ray, and those that do not overlap are at most `most`. Pieces whose
// lengths lie within one octave do not overlap, and lengths have eight octaves
// (shaders/slicing/lit_cell.glsl): 8 * most trials in vain, and as length doubles after two pieces
// of full length, twice as many of these. Whole parts of which that is true are at most `most`,
// too: each takes a round to be found, up to three stretches that begin with pieces of an eighth,
// and so ten rounds in all.
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

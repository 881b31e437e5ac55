// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/lighting.h"
#include "lamina/scene.h"

namespace lamina {

// Lighting of a scene as it is drawn.
struct LightPlan {
    std::optional<Lighting> lighting;  // with the smallest gradient that is lit
    // Bend of light above which pieces of rays are cut (slicing/cpu_light-inl.h).
    double most_bend = 0;
    double light_error = 0;  // error that this leaves, in 1/255

    friend bool operator==(const LightPlan&, const LightPlan&) = default;
};

// Plans the light of a scene. `max_color`: of the unlit picture. `cuts_rays`: tells
// whether rays are cut at bends of light.
LightPlan plan_light(const Scene& scene, double max_color, bool cuts_rays);

// Returns the largest number of loop rounds that an OpenGL fragment takes, beyond those of unlit
// scenes, to cut its ray at bends of light.
double light_rounds(const Scene& scene, double max_color);

// Returns the largest colour component that the scene may draw.
double largest_drawn_color(const Scene& scene, double max_color);

// Throw Error for a lit scene that the method cannot draw lit; nothing is drawn unlit instead.
void check_lit_slicing(const Scene& scene);
void check_lit_projection(const Scene& scene);

}  // namespace lamina

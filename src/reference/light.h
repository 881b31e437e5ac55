// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "optics/ray_lights.h"
#include "reference/cells.h"
#include "reference/integrate.h"

namespace lamina {

// A piece of a ray with a gradient, on which extinction and colour are linear functions of one
// position x.
struct LitPiece {
    EmissionPiece emission;
    glm::dvec3 color{0}, color_change{0};  // at x = 0, and from there to x = 1
    GradientAlong gradient;
};

struct LightIntegral {
    glm::dvec3 value{0};
    double error = 0;  // estimate of the largest component's error; the true one is smaller
};

// What light adds to the emission of the piece: the integral of RayLights::Effect::on(colour)
// extinction(t) exp(-depth(t)) over [0, 1]. The allowed errors are those of integrate_emission().
//
// The integrand has kinks where the gradient is perpendicular to a light or a halfway vector:
// intervals end there. It may have dips and peaks that are narrow where the gradient is small and
// turns quickly: rules are trusted only where the gradient turns and grows by so little in an
// interval that their nodes cannot miss any.
LightIntegral integrate_light(const LitPiece& piece, const RayLights& lights, double error_per_t,
                              double error_per_opacity);

}  // namespace lamina

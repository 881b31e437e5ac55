// SPDX-License-Identifier: Apache-2.0
// The colour that light adds to a piece (docs/numerics.md, section 10.3):
//
//   kinks = the roots of g.l and g.h, for the gradient g and each light's l and h
//   for each interval of the piece between two kinks:
//       ball = one that g stays in, around its value in the middle
//       if the largest effect of light in the ball (10.2) is below the allowed error:
//           its value in the middle
//       else if g grows and turns by little in the ball:
//           Patterson's rules (integrate.h), as soon as two that follow each other agree
//       else halve the interval
//
// Dips and peaks of the effect are narrow if the gradient is small and turns quickly. In a ball
// that is small beside the gradient's length no dip and no peak fits between the nodes of a rule.
#pragma once

#include <glm/vec3.hpp>

#include "optics/ray_lights.h"
#include "reference/cubic.h"
#include "reference/integrate.h"

namespace lamina {

// A piece of a ray with a gradient, on which extinction and colour are linear functions of one
// position x.
struct LitPiece {
    EmissionPiece emission;
    glm::dvec3 color{0}, color_change{0};  // at x = 0, and from there to x = 1
    GradientAlong gradient;
};

using LightIntegral = Integral<glm::dvec3>;

// Returns the integral over [0, 1] of the effect of light on the colour,
// RayLights::Effect::on(colour), times extinction(t) exp(-depth(t)). The allowed errors are those
// of integrate_emission().
LightIntegral integrate_light(const LitPiece& piece, const RayLights& lights, double error_per_t,
                              double error_per_opacity);

}  // namespace lamina

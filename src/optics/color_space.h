// SPDX-License-Identifier: Apache-2.0
// The colour spaces in which ParaView interpolates its colour maps. The colours at both ends are
// sRGB in [0, 1].
#pragma once

#include <glm/vec3.hpp>

namespace lamina {

// step: the whole interval has the colour of its upper end, as in VTK. diverging: interpolation in
// the polar form Msh of CIELAB (Moreland, "Diverging Color Maps for Scientific Visualization", ISVC
// 2009).
enum class ColorSpace { rgb, hsv, hsv_wrapped, lab, diverging, step };

glm::dvec3 linear_from_srgb(const glm::dvec3& srgb);

// The colour at `share` in [0, 1] of the way from `a` to `b`, in sRGB, clipped to its gamut.
glm::dvec3 interpolate_srgb(ColorSpace space, const glm::dvec3& a, const glm::dvec3& b,
                            double share);

}  // namespace lamina

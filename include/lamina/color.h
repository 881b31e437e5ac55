// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <string>

#include "lamina/export.h"
#include "lamina/image_color_space.h"

namespace lamina {

// Returns a colour that is written as "#ff8019" or as a CSS name like "tomato", in the numbers of
// `space`. Such texts mean display values (sRGB), which are decoded for ImageColorSpace::linear.
// Throws Error for other texts.
LAMINA_API glm::dvec3 color_of(const std::string& text,
                               ImageColorSpace space = ImageColorSpace::linear);
// Returns the colour of three display values 0..1, in the numbers of `space`.
LAMINA_API glm::dvec3 color_of_display(const glm::dvec3& display,
                                       ImageColorSpace space = ImageColorSpace::linear);
// Returns the display values of a colour, the inverse of color_of_display() up to rounding.
// Components above 1 become 1.
LAMINA_API glm::dvec3 display_of_color(const glm::dvec3& color,
                                       ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina

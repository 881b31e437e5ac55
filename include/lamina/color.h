// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <string>

#include "lamina/export.h"
#include "lamina/image_color_space.h"

namespace lamina {

// A colour as people write it, "#ff8019" or a CSS name like "tomato", in the numbers of `space`.
// Such colours are display values (sRGB): they are decoded for ImageColorSpace::linear. Throws
// Error for other texts.
LAMINA_API glm::dvec3 color_of(const std::string& text,
                               ImageColorSpace space = ImageColorSpace::linear);
// The same for three display values 0..1.
LAMINA_API glm::dvec3 color_of_display(const glm::dvec3& display,
                                       ImageColorSpace space = ImageColorSpace::linear);
// The display values of a colour of `space`: color_of_display() gives it back, up to rounding.
// Components beyond 1 are shown as 1.
LAMINA_API glm::dvec3 display_of_color(const glm::dvec3& color,
                                       ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina

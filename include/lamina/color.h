// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <string>
#include <vector>

#include "lamina/error.h"
#include "lamina/image.h"

namespace lamina {

// Returns the colour that a text like "#ff8019", or a CSS name like "tomato", means, as numbers of
// `space`. Such texts mean display values (sRGB), which are decoded for ImageColorSpace::linear.
// Throws Error for other texts.
LAMINA_API glm::dvec3 color_of(const std::string& text,
                               ImageColorSpace space = ImageColorSpace::linear);
// Returns the colour of three display values 0..1, as numbers of `space`.
LAMINA_API glm::dvec3 color_of_display(const glm::dvec3& display,
                                       ImageColorSpace space = ImageColorSpace::linear);
// Returns the display values of a colour, the inverse of color_of_display() up to rounding.
// Components above 1 become 1.
LAMINA_API glm::dvec3 display_of_color(const glm::dvec3& color,
                                       ImageColorSpace space = ImageColorSpace::linear);

// A colour at a value.
struct ColorPoint {
    double value = 0;
    glm::dvec3 color{0};
};

// An opacity at a value.
struct OpacityPoint {
    double value = 0;
    double opacity = 0;  // 0..1, over a unit length
};

// A colour map: colour, and perhaps opacity, as piecewise linear functions of the scalar. They are
// constant outside their points; two points at one value make a step.
struct Colormap {
    std::vector<ColorPoint> colors;       // at least one
    std::vector<OpacityPoint> opacities;  // empty if the file has no opacity function
    // True if the values are data values (as in a preset in HU), so that the map must not be
    // stretched over the range of other data.
    bool own_range = true;
};

// Returns the names of the shipped colour maps (docs/scene.md), in alphabetical order.
LAMINA_API std::vector<std::string> colormap_names();

// Returns the shipped map of this name, or else the ParaView preset (JSON) of this path, with
// colours as numbers of `space`. Straight lines between the points of the result follow the map
// within 5e-4. Throws Error, with the most similar name, if there is neither.
LAMINA_API Colormap load_colormap(const std::string& name_or_path,
                                  ImageColorSpace space = ImageColorSpace::linear);

}  // namespace lamina

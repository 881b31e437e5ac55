// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina {

struct ColorPoint {
    double value = 0;
    glm::dvec3 color{0};  // linear light
};

struct OpacityPoint {
    double value = 0;
    double opacity = 0;  // 0..1, over a unit length
};

struct ExtinctionPoint {
    double value = 0;
    double extinction = 0;  // per world unit
};

// Piecewise linear functions of the scalar, constant outside their points; two points at one value
// make a step.
struct Colormap {
    std::vector<ColorPoint> colors;       // at least one
    std::vector<OpacityPoint> opacities;  // empty where the file has no opacity function
};

// Reads a ParaView preset, which is a JSON object or an array whose first element is used. Known
// keys: ColorSpace ("RGB" where absent, "HSV" with HSVWrap, "Lab", "Diverging", "Step"), RGBPoints
// [x, r, g, b, ...] in sRGB, Points [x, opacity, midpoint, sharpness, ...]. Between its points the
// map is sampled in its own colour space, so finely that linear interpolation in linear light is
// within 5e-4. Throws Error, which names the file and the key.
Colormap read_paraview_colormap(const std::filesystem::path& file);

// Combines colours and extinctions over the union of both sets of points. A step of either becomes
// a step.
std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions);

// The same with the file's own opacities. They are converted at their points and at 15 values
// between two points that differ. Throws Error where the file has none. unit_length > 0, in world
// units.
std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length);

}  // namespace lamina

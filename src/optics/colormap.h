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

// A ParaView preset: JSON, an object or an array whose first element counts. Known keys: ColorSpace
// ("RGB" where absent, "HSV" with HSVWrap, "Lab", "Diverging", "Step"), RGBPoints [x, r, g, b, ...]
// in sRGB, Points [x, opacity, midpoint, sharpness, ...]. Between its points the map is sampled in
// its own colour space, so finely that straight lines in linear light are within 5e-4. Throws Error
// that names file and key.
Colormap read_paraview_colormap(const std::filesystem::path& file);

// Colours and extinctions over the union of both sets of points; a step of either becomes a step.
std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions);

// With the file's own opacities, converted at their points and at 15 values between two that
// differ; throws Error where there are none. unit_length > 0, in world units.
std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length);

}  // namespace lamina

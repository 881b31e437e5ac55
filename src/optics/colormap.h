// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lamina/colormap.h"
#include "lamina/image_color_space.h"
#include "lamina/transfer_function.h"
#include "optics/given_points.h"

namespace lamina {

struct ExtinctionPoint {
    double value = 0;
    double extinction = 0;  // per world unit
    bool smooth = false;    // as in TransferKnot
};

// Reads a ParaView preset, which is a JSON object or an array whose first element is used. Known
// keys: ColorSpace ("RGB" where absent, "HSV" with HSVWrap, "Lab", "Diverging", "Step"), RGBPoints
// [x, r, g, b, ...] in sRGB, Points [x, opacity, midpoint, sharpness, ...]. Between its points the
// map is sampled in its own colour space, so finely that linear interpolation in `space`, which its
// colours are converted to, is within 5e-4. Throws Error, which names the file and the key.
Colormap read_paraview_colormap(const std::filesystem::path& file,
                                ImageColorSpace space = ImageColorSpace::linear);
// The same of an object that was read; `name` stands for the file in messages.
Colormap colormap_of(const nlohmann::json& preset, const std::string& name, ImageColorSpace space);

// Stretches the map, whose colours must not all be at one value, from the first and last of these
// values to lo and hi > lo; opacities with them.
void stretch(Colormap& colormap, double lo, double hi);

// Combines colours and extinctions over the union of both sets of points. A step of either becomes
// a step.
std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions);

// The same with the map's own opacities, linear between its points (optics/given_points.h). Throws
// Error where it has none. unit_length > 0, in world units.
std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length);
// The map's own opacities as points, without colours.
std::vector<GivenPoint> given_points(const Colormap& colormap);

}  // namespace lamina

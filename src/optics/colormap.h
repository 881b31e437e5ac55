// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/input_file.h"
#include "lamina/colormap.h"
#include "lamina/image_color_space.h"
#include "lamina/transfer_function.h"
#include "optics/opacity.h"

namespace lamina {

struct ExtinctionPoint {
    double value = 0;
    double extinction = 0;  // per world unit
    bool smooth = false;    // as in TransferKnot
};

// Reads a ParaView preset, which is a JSON object or an array whose first element is used. Known
// keys: ColorSpace ("RGB" if absent, "HSV" with HSVWrap, "Lab", "Diverging", "Step"), RGBPoints [x,
// r, g, b, ...] in sRGB, Points [x, opacity, midpoint, sharpness, ...]. Colours are converted to
// `space`. Between its points the map is sampled in its own colour space, so finely that linear
// interpolation in `space` is within 5e-4. Throws Error, which names the file and the key.
Colormap read_paraview_colormap(const std::filesystem::path& file,
                                ImageColorSpace space = ImageColorSpace::linear);
// Reads a preset from parsed JSON; `name` stands for the file in messages.
Colormap colormap_of(const nlohmann::json& preset, const std::string& name, ImageColorSpace space);

// Maps the first and the last value of the map linearly to lo and hi > lo, opacities included. The
// map's colours must have more than one value.
void stretch(Colormap& colormap, double lo, double hi);

// Combines colours and extinctions over the union of both sets of points. A step of either becomes
// a step.
std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions);

// Combines the colours with the map's own opacities, which are linear between its points
// (optics/opacity.h). unit_length > 0 is in world units. Throws Error if the map has no
// opacities.
std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length);
// The map's own opacities as points, without colours.
std::vector<GivenPoint> given_points(const Colormap& colormap);

// The files of share/colormaps, "viridis.json" and others.
std::span<const EmbeddedFile> embedded_colormaps();

// Tells whether lamina ships a colour map of this name (share/colormaps).
bool is_colormap_name(const std::string& name);

}  // namespace lamina

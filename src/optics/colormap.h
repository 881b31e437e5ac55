// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string_view>
#include "base/input_file.h"
#include "lamina/color.h"
#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "optics/opacity.h"

namespace lamina {

// step: the colour of the upper end, as in VTK. diverging: interpolation in Msh of CIELAB
// (Moreland, "Diverging Color Maps for Scientific Visualization", ISVC 2009).
enum class ColorSpace { rgb, hsv, hsv_wrapped, lab, diverging, step };

glm::dvec3 linear_from_srgb(const glm::dvec3& srgb);

// The colour at `share` in [0, 1] of the way from `a` to `b`, in sRGB, clipped to its gamut.
glm::dvec3 interpolate_srgb(ColorSpace space, const glm::dvec3& a, const glm::dvec3& b,
                            double share);

struct CssColor {
    std::string_view name;
    std::uint32_t rgb;  // 0xrrggbb, sRGB
};

// The named colours of CSS (W3C, "CSS Color Module Level 4", section 6.1), by name.
std::span<const CssColor> css_colors();

std::optional<std::uint32_t> css_color(std::string_view name);

struct ExtinctionPoint {
    double value = 0;
    double extinction = 0;  // per world unit
    bool smooth = false;    // as in TransferKnot
};

// Reads a ParaView preset: a JSON object, or the first of an array. Keys: ColorSpace ("RGB" if
// absent), HSVWrap, RGBPoints [x, r, g, b, ...] in sRGB, Points [x, opacity, midpoint, sharpness,
// ...]. Linear interpolation in `space` is within 5e-4 of the map. Throws Error.
Colormap read_paraview_colormap(const std::filesystem::path& file,
                                ImageColorSpace space = ImageColorSpace::linear);
// Reads a preset from parsed JSON; `name` stands for the file in messages.
Colormap colormap_of(const nlohmann::json& preset, const std::string& name, ImageColorSpace space);

// Maps the first and the last value, which differ, linearly to lo and hi > lo, opacities included.
void stretch(Colormap& colormap, double lo, double hi);

// Combines both sets of points. A step of either becomes a step.
std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions);

// Combines the colours with the map's own opacities, linear between points (optics/opacity.h).
// unit_length > 0 is in world units. Throws Error if there are none.
std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length);
// The map's own opacities as points, without colours.
std::vector<GivenPoint> given_points(const Colormap& colormap);

// The files of share/colormaps, "viridis.json" and others.
std::span<const EmbeddedFile> embedded_colormaps();

bool is_colormap_name(const std::string& name);

}  // namespace lamina

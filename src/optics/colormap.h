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

// How ParaView presets are interpolated. hsv_wrapped: the shorter way around the hue circle.
// diverging: in Msh, polar coordinates of CIELAB (Moreland, "Diverging Color Maps for Scientific
// Visualization", ISVC 2009). step: the upper point's colour, as in VTK.
enum class ColorSpace { rgb, hsv, hsv_wrapped, lab, diverging, step };

glm::dvec3 linear_from_srgb(const glm::dvec3& srgb);

// Interpolates from `a` (share 0) to `b` (share 1), in sRGB, clipped to its gamut.
glm::dvec3 interpolate_srgb(ColorSpace space, const glm::dvec3& a, const glm::dvec3& b,
                            double share);

struct CssColor {
    std::string_view name;
    std::uint32_t rgb;  // 0xrrggbb, sRGB
};

// Returns the named colours of CSS (W3C, "CSS Color Module Level 4", section 6.1), sorted by name.
std::span<const CssColor> css_colors();

std::optional<std::uint32_t> css_color(std::string_view name);

struct ExtinctionPoint {
    double value = 0;
    double extinction = 0;  // per world unit
    bool smooth = false;    // TransferKnot::smooth
};

// Reads a ParaView preset: a JSON object, or the first element of an array. Keys: ColorSpace ("RGB"
// if absent), HSVWrap, RGBPoints [x, r, g, b, ...] in sRGB, Points [x, opacity, midpoint,
// sharpness, ...]. Adds points until linear interpolation in `space` is within 5e-4. Throws Error.
Colormap read_paraview_colormap(const std::filesystem::path& file,
                                ImageColorSpace space = ImageColorSpace::linear);
// Converts a preset that is already parsed; messages call it `name`.
Colormap colormap_of(const nlohmann::json& preset, const std::string& name, ImageColorSpace space);

// Maps the values of all points, also of opacities: the first colour's to lo, the last one's to hi.
void stretch(Colormap& colormap, double lo, double hi);

// Makes a knot at each value of a point of the map or of `extinctions`. Steps of either stay steps.
std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions);

// Makes points of the map's colours and its own opacities, which are linear between points
// (optics/opacity.h). unit_length > 0: world units. Throws Error if the map has no opacities.
std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length);
// Returns the map's own opacities as points, without colours.
std::vector<GivenPoint> given_points(const Colormap& colormap);

// Returns the files of share/colormaps, "viridis.json" and others, which are compiled into lamina.
std::span<const EmbeddedFile> embedded_colormaps();

bool is_colormap_name(const std::string& name);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// The colour spaces in which ParaView interpolates its colour maps. The colours at both ends are
// sRGB in [0, 1].
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string_view>

namespace lamina {

// step: the whole interval has the colour of its upper end, as in VTK. diverging: interpolation in
// the polar form Msh of CIELAB (Moreland, "Diverging Color Maps for Scientific Visualization", ISVC
// 2009).
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

// The code of a name in small letters.
std::optional<std::uint32_t> css_color(std::string_view name);

}  // namespace lamina

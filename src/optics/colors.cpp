// SPDX-License-Identifier: Apache-2.0
#include "optics/colormap.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <set>

#include "base/error.h"
#include "image/coded_image.h"
#include "lamina/color.h"

namespace lamina {
namespace {

using std::numbers::pi;

// Columns: XYZ (white D65) of the linear primaries, IEC 61966-2-1.
const glm::dmat3 xyz_from_linear(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722,
                                 0.9505);
const glm::dmat3 linear_from_xyz = glm::inverse(xyz_from_linear);
const glm::dvec3 white = xyz_from_linear * glm::dvec3(1);

// The function f of CIELAB (CIE 15): the cube root, replaced by its tangent near 0.
constexpr double knee = 6.0 / 29.0;
double lab_curve(double t) {
    return t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29.0;
}
double lab_curve_inverse(double f) {
    return f > knee ? f * f * f : 3 * knee * knee * (f - 4.0 / 29.0);
}

glm::dvec3 lab_from_srgb(const glm::dvec3& srgb) {
    const glm::dvec3 xyz = xyz_from_linear * linear_from_srgb(srgb) / white;
    const double x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
    return glm::dvec3(116 * y - 16, 500 * (x - y), 200 * (y - z));
}

// Clips as VTK does: divides by the largest component if it exceeds 1, then sets those < 0 to 0.
glm::dvec3 srgb_from_lab(const glm::dvec3& lab) {
    const double y = (lab[0] + 16) / 116, x = y + lab[1] / 500, z = y - lab[2] / 200;
    const glm::dvec3 xyz(lab_curve_inverse(x), lab_curve_inverse(y), lab_curve_inverse(z));
    const glm::dvec3 linear = linear_from_xyz * (xyz * white);
    glm::dvec3 srgb(srgb_from_linear(linear.r), srgb_from_linear(linear.g),
                    srgb_from_linear(linear.b));
    srgb /= std::max({srgb.r, srgb.g, srgb.b, 1.0});
    return glm::max(srgb, glm::dvec3(0));
}

// Returns hue in [0, 1), saturation, value.
glm::dvec3 hsv_from_srgb(const glm::dvec3& srgb) {
    const double value = std::max({srgb.r, srgb.g, srgb.b});
    const double chroma = value - std::min({srgb.r, srgb.g, srgb.b});
    if (chroma == 0) return glm::dvec3(0, 0, value);
    double sixth = 0;
    if (value == srgb.r) {
        sixth = (srgb.g - srgb.b) / chroma;
    } else if (value == srgb.g) {
        sixth = 2 + (srgb.b - srgb.r) / chroma;
    } else {
        sixth = 4 + (srgb.r - srgb.g) / chroma;
    }
    return glm::dvec3(sixth < 0 ? sixth / 6 + 1 : sixth / 6, chroma / value, value);
}

glm::dvec3 srgb_from_hsv(const glm::dvec3& hsv) {
    const auto channel = [&](double n) {
        const double k = std::fmod(n + 6 * hsv[0], 6.0);
        return hsv[2] * (1 - hsv[1] * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
    };
    return glm::dvec3(channel(5), channel(3), channel(1));
}

glm::dvec3 interpolate_hsv(const glm::dvec3& a, const glm::dvec3& b, double share, bool wrapped) {
    glm::dvec3 from = hsv_from_srgb(a), to = hsv_from_srgb(b);
    if (wrapped && std::abs(from[0] - to[0]) > 0.5) (from[0] > to[0] ? from[0] : to[0]) -= 1;
    glm::dvec3 hsv = glm::mix(from, to, share);
    if (hsv[0] < 0) hsv[0] += 1;
    return srgb_from_hsv(hsv);
}

// Polar coordinates of CIELAB: Moreland 2009, section 4.2.
struct Msh {
    double magnitude, saturation, hue;  // saturation and hue are angles in radians
};

Msh msh_from_srgb(const glm::dvec3& srgb) {
    const glm::dvec3 lab = lab_from_srgb(srgb);
    const double magnitude = glm::length(lab);
    const double saturation =
        magnitude > 1e-3 ? std::acos(std::clamp(lab[0] / magnitude, -1.0, 1.0)) : 0;
    return {magnitude, saturation, saturation > 1e-3 ? std::atan2(lab[2], lab[1]) : 0};
}

glm::dvec3 srgb_from_msh(const Msh& msh) {
    const double chroma = msh.magnitude * std::sin(msh.saturation);
    return srgb_from_lab(glm::dvec3(msh.magnitude * std::cos(msh.saturation),
                                    chroma * std::cos(msh.hue), chroma * std::sin(msh.hue)));
}

// Returns an unsaturated end's hue: the saturated end's, turned (Moreland 2009, section 4.3).
double spun_hue(const Msh& saturated, double unsaturated_magnitude) {
    if (saturated.magnitude >= unsaturated_magnitude - 0.1) return saturated.hue;
    const double reach = std::sqrt(unsaturated_magnitude * unsaturated_magnitude -
                                   saturated.magnitude * saturated.magnitude);
    const double spin =
        saturated.saturation * reach / (saturated.magnitude * std::sin(saturated.saturation));
    return saturated.hue > -0.3 * pi ? saturated.hue + spin : saturated.hue - spin;
}

glm::dvec3 interpolate_diverging(const glm::dvec3& a, const glm::dvec3& b, double share) {
    constexpr double saturated = 0.05;
    Msh from = msh_from_srgb(a), to = msh_from_srgb(b);
    const double turn = std::abs(std::remainder(from.hue - to.hue, 2 * pi));
    if (from.saturation > saturated && to.saturation > saturated && turn > 0.33 * pi) {
        const Msh middle{std::max({from.magnitude, to.magnitude, 88.0}), 0, 0};
        (share < 0.5 ? to : from) = middle;
        share = share < 0.5 ? 2 * share : 2 * share - 1;
    }
    if (from.saturation < saturated && to.saturation > saturated) {
        from.hue = spun_hue(to, from.magnitude);
    } else if (to.saturation < saturated && from.saturation > saturated) {
        to.hue = spun_hue(from, to.magnitude);
    }
    return srgb_from_msh({glm::mix(from.magnitude, to.magnitude, share),
                          glm::mix(from.saturation, to.saturation, share),
                          glm::mix(from.hue, to.hue, share)});
}

constexpr CssColor colors[] = {
    {"aliceblue", 0xf0f8ff},
    {"antiquewhite", 0xfaebd7},
    {"aqua", 0x00ffff},
    {"aquamarine", 0x7fffd4},
    {"azure", 0xf0ffff},
    {"beige", 0xf5f5dc},
    {"bisque", 0xffe4c4},
    {"black", 0x000000},
    {"blanchedalmond", 0xffebcd},
    {"blue", 0x0000ff},
    {"blueviolet", 0x8a2be2},
    {"brown", 0xa52a2a},
    {"burlywood", 0xdeb887},
    {"cadetblue", 0x5f9ea0},
    {"chartreuse", 0x7fff00},
    {"chocolate", 0xd2691e},
    {"coral", 0xff7f50},
    {"cornflowerblue", 0x6495ed},
    {"cornsilk", 0xfff8dc},
    {"crimson", 0xdc143c},
    {"cyan", 0x00ffff},
    {"darkblue", 0x00008b},
    {"darkcyan", 0x008b8b},
    {"darkgoldenrod", 0xb8860b},
    {"darkgray", 0xa9a9a9},
    {"darkgreen", 0x006400},
    {"darkgrey", 0xa9a9a9},
    {"darkkhaki", 0xbdb76b},
    {"darkmagenta", 0x8b008b},
    {"darkolivegreen", 0x556b2f},
    {"darkorange", 0xff8c00},
    {"darkorchid", 0x9932cc},
    {"darkred", 0x8b0000},
    {"darksalmon", 0xe9967a},
    {"darkseagreen", 0x8fbc8f},
    {"darkslateblue", 0x483d8b},
    {"darkslategray", 0x2f4f4f},
    {"darkslategrey", 0x2f4f4f},
    {"darkturquoise", 0x00ced1},
    {"darkviolet", 0x9400d3},
    {"deeppink", 0xff1493},
    {"deepskyblue", 0x00bfff},
    {"dimgray", 0x696969},
    {"dimgrey", 0x696969},
    {"dodgerblue", 0x1e90ff},
    {"firebrick", 0xb22222},
    {"floralwhite", 0xfffaf0},
    {"forestgreen", 0x228b22},
    {"fuchsia", 0xff00ff},
    {"gainsboro", 0xdcdcdc},
    {"ghostwhite", 0xf8f8ff},
    {"gold", 0xffd700},
    {"goldenrod", 0xdaa520},
    {"gray", 0x808080},
    {"green", 0x008000},
    {"greenyellow", 0xadff2f},
    {"grey", 0x808080},
    {"honeydew", 0xf0fff0},
    {"hotpink", 0xff69b4},
    {"indianred", 0xcd5c5c},
    {"indigo", 0x4b0082},
    {"ivory", 0xfffff0},
    {"khaki", 0xf0e68c},
    {"lavender", 0xe6e6fa},
    {"lavenderblush", 0xfff0f5},
    {"lawngreen", 0x7cfc00},
    {"lemonchiffon", 0xfffacd},
    {"lightblue", 0xadd8e6},
    {"lightcoral", 0xf08080},
    {"lightcyan", 0xe0ffff},
    {"lightgoldenrodyellow", 0xfafad2},
    {"lightgray", 0xd3d3d3},
    {"lightgreen", 0x90ee90},
    {"lightgrey", 0xd3d3d3},
    {"lightpink", 0xffb6c1},
    {"lightsalmon", 0xffa07a},
    {"lightseagreen", 0x20b2aa},
    {"lightskyblue", 0x87cefa},
    {"lightslategray", 0x778899},
    {"lightslategrey", 0x778899},
    {"lightsteelblue", 0xb0c4de},
    {"lightyellow", 0xffffe0},
    {"lime", 0x00ff00},
    {"limegreen", 0x32cd32},
    {"linen", 0xfaf0e6},
    {"magenta", 0xff00ff},
    {"maroon", 0x800000},
    {"mediumaquamarine", 0x66cdaa},
    {"mediumblue", 0x0000cd},
    {"mediumorchid", 0xba55d3},
    {"mediumpurple", 0x9370db},
    {"mediumseagreen", 0x3cb371},
    {"mediumslateblue", 0x7b68ee},
    {"mediumspringgreen", 0x00fa9a},
    {"mediumturquoise", 0x48d1cc},
    {"mediumvioletred", 0xc71585},
    {"midnightblue", 0x191970},
    {"mintcream", 0xf5fffa},
    {"mistyrose", 0xffe4e1},
    {"moccasin", 0xffe4b5},
    {"navajowhite", 0xffdead},
    {"navy", 0x000080},
    {"oldlace", 0xfdf5e6},
    {"olive", 0x808000},
    {"olivedrab", 0x6b8e23},
    {"orange", 0xffa500},
    {"orangered", 0xff4500},
    {"orchid", 0xda70d6},
    {"palegoldenrod", 0xeee8aa},
    {"palegreen", 0x98fb98},
    {"paleturquoise", 0xafeeee},
    {"palevioletred", 0xdb7093},
    {"papayawhip", 0xffefd5},
    {"peachpuff", 0xffdab9},
    {"peru", 0xcd853f},
    {"pink", 0xffc0cb},
    {"plum", 0xdda0dd},
    {"powderblue", 0xb0e0e6},
    {"purple", 0x800080},
    {"rebeccapurple", 0x663399},
    {"red", 0xff0000},
    {"rosybrown", 0xbc8f8f},
    {"royalblue", 0x4169e1},
    {"saddlebrown", 0x8b4513},
    {"salmon", 0xfa8072},
    {"sandybrown", 0xf4a460},
    {"seagreen", 0x2e8b57},
    {"seashell", 0xfff5ee},
    {"sienna", 0xa0522d},
    {"silver", 0xc0c0c0},
    {"skyblue", 0x87ceeb},
    {"slateblue", 0x6a5acd},
    {"slategray", 0x708090},
    {"slategrey", 0x708090},
    {"snow", 0xfffafa},
    {"springgreen", 0x00ff7f},
    {"steelblue", 0x4682b4},
    {"tan", 0xd2b48c},
    {"teal", 0x008080},
    {"thistle", 0xd8bfd8},
    {"tomato", 0xff6347},
    {"turquoise", 0x40e0d0},
    {"violet", 0xee82ee},
    {"wheat", 0xf5deb3},
    {"white", 0xffffff},
    {"whitesmoke", 0xf5f5f5},
    {"yellow", 0xffff00},
    {"yellowgreen", 0x9acd32},
};

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

glm::dvec3 display_of_code(std::uint32_t rgb) {
    return glm::dvec3(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255) / 255.0;
}

std::optional<std::uint32_t> code_of_hex(const std::string& text) {
    constexpr const char* digits = "0123456789abcdef";
    if (text.size() != 7 || text.find_first_not_of(digits, 1) != std::string::npos) return {};
    return static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16));
}

}  // namespace

glm::dvec3 linear_from_srgb(const glm::dvec3& srgb) {
    return glm::dvec3(linear_from_srgb(srgb.r), linear_from_srgb(srgb.g), linear_from_srgb(srgb.b));
}

glm::dvec3 interpolate_srgb(ColorSpace space, const glm::dvec3& a, const glm::dvec3& b,
                            double share) {
    switch (space) {
        case ColorSpace::rgb:
            return glm::mix(a, b, share);
        case ColorSpace::hsv:
            return interpolate_hsv(a, b, share, false);
        case ColorSpace::hsv_wrapped:
            return interpolate_hsv(a, b, share, true);
        case ColorSpace::lab:
            return srgb_from_lab(glm::mix(lab_from_srgb(a), lab_from_srgb(b), share));
        case ColorSpace::diverging:
            return interpolate_diverging(a, b, share);
        case ColorSpace::step:
            return b;
    }
    return b;
}

std::span<const CssColor> css_colors() {
    return colors;
}

std::optional<std::uint32_t> css_color(std::string_view name) {
    const auto* const found = std::ranges::lower_bound(colors, name, {}, &CssColor::name);
    if (found == std::end(colors) || found->name != name) return std::nullopt;
    return found->rgb;
}

glm::dvec3 color_of_display(const glm::dvec3& display, ImageColorSpace space) {
    return space == ImageColorSpace::display ? display : linear_from_srgb(display);
}

glm::dvec3 display_of_color(const glm::dvec3& color, ImageColorSpace space) {
    glm::dvec3 display = glm::clamp(color, 0.0, 1.0);
    if (space == ImageColorSpace::linear) {
        for (int c = 0; c < 3; ++c) display[c] = srgb_from_linear(display[c]);
    }
    return display;
}

glm::dvec3 color_of(const std::string& text, ImageColorSpace space) {
    const std::string word = lower(text);
    const bool hex = word.starts_with('#');
    if (const auto code = hex ? code_of_hex(word) : css_color(word))
        return color_of_display(display_of_code(*code), space);
    if (hex)
        fail("found \"{}\", expected # and six hexadecimal digits, as in \"#ff8019\"",
             shortened(text));
    std::set<std::string> names;
    for (const CssColor& color : css_colors()) names.emplace(color.name);
    const std::string near = suggestion(names, word);
    fail("found \"{}\"{}", shortened(text),
         near.starts_with(", did") ? near
                                   : ", expected \"#rrggbb\" or the name of a CSS colour, as in "
                                     "\"tomato\"");
}

}  // namespace lamina

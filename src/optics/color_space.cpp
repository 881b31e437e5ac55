// SPDX-License-Identifier: Apache-2.0
#include "optics/color_space.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/srgb.h"

namespace lamina {

namespace {

using std::numbers::pi;

// Columns: XYZ (white D65) of the linear primaries, IEC 61966-2-1.
const glm::dmat3 xyz_from_linear(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722,
                                 0.9505);
const glm::dmat3 linear_from_xyz = glm::inverse(xyz_from_linear);
const glm::dvec3 white = xyz_from_linear * glm::dvec3(1);

// CIE 15: the cube root is continued by its tangent near 0.
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

// Colours outside the gamut become darker if a component exceeds 1; negative components become 0,
// as in VTK.
glm::dvec3 srgb_from_lab(const glm::dvec3& lab) {
    const double y = (lab[0] + 16) / 116, x = y + lab[1] / 500, z = y - lab[2] / 200;
    const glm::dvec3 xyz(lab_curve_inverse(x), lab_curve_inverse(y), lab_curve_inverse(z));
    const glm::dvec3 linear = linear_from_xyz * (xyz * white);
    glm::dvec3 srgb(srgb_from_linear(linear.r), srgb_from_linear(linear.g),
                    srgb_from_linear(linear.b));
    srgb /= std::max({srgb.r, srgb.g, srgb.b, 1.0});
    return glm::max(srgb, glm::dvec3(0));
}

// Hue in [0, 1), saturation, value.
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

struct Msh {
    double magnitude, saturation, hue;
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

// Moreland 2009, section 4.3: the hue of an unsaturated end is turned so that the perceived change
// is even.
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

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/settings.h"

namespace lamina {

// Lighting::smallest_gradient, if set, as mantissa * 2^exponent, since float32 may not hold it.
struct SmallestGradient {
    float mantissa = 1;  // 1 to 2
    int exponent = 0;
};

inline SmallestGradient smallest_gradient_of(const Lighting& lighting) {
    const int exponent = std::ilogb(*lighting.smallest_gradient);
    return {static_cast<float>(std::ldexp(*lighting.smallest_gradient, -exponent)), exponent};
}

// Thresholds at which a lit piece of a ray is cut because its gradient turns too much.
struct LightCuts {
    // A turn is the largest distance of a piece's gradients from the one in its middle, as a share
    // of that one's length. Beyond most_turn, highlights of up to highlight_effect may lie between
    // the nodes of Gauss' rule; beyond most_plain_turn, other light of up to plain_effect may.
    double most_turn = 0, highlight_effect = 0;
    double most_plain_turn = 0, plain_effect = 0;

    double largest_effect() const { return highlight_effect + plain_effect; }
};

// Share of the largest bend (CpuLight::most_bend) that a faint piece may keep, weighted by its
// opacity. A ray has a few faint pieces under light of strength 1, and more under stronger light.
// The shaders have their own share, 1/4 (slicing/cell_light.glsl, projection/light_along.glsl).
inline constexpr double faint_share_of_cells = 1.0 / 2, faint_share_of_tets = 1.0 / 4;

LightCuts light_cuts(const Lighting& lighting);

// A lighting in the form that vector code computes with, along three orthogonal axes.
struct CpuLight {
    struct Direction {
        bool to_eye = false;              // true: a headlight, which has no to_light
        std::array<float, 3> to_light{};  // unit vector along the axes
        std::array<float, 3> color{};
        float largest_color = 0;  // max component of color
    };
    std::vector<Direction> directions;
    bool gray = false;  // all components of each colour are equal
    float ambient = 0, diffuse = 0, specular = 0;
    float half_power = 0;      // half of Lighting::power: the exponent of a squared cosine
    int whole_half_power = 0;  // half_power if it is a whole number, else 0
    SmallestGradient smallest;
    std::array<float, 3> spacing{};  // lengths of the axes
    // Bend of light along a piece of a ray above which the piece is cut, unless it is faint.
    float most_bend = 0;
    // A piece is faint if its bend times its opacity is below this.
    float faint_bend = 0;
    // LightCuts, the turns reduced for strong light.
    float most_turn = 0, highlight_effect = 0;
    float most_plain_turn = 0, plain_effect = 0;
};

// `axes`: orthogonal, in the unit of lengths along rays. `faint_share`: see faint_share_of_cells.
CpuLight make_tile_light(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                         double most_bend, double faint_share);

}  // namespace lamina

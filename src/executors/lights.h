// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/settings.h"

namespace lamina {

// The smallest gradient of a lighting that has one, as mantissa * 2^exponent. It may be smaller or
// larger than all numbers of float32.
struct SmallestGradient {
    float mantissa = 1;  // 1 to 2
    int exponent = 0;
};

inline SmallestGradient smallest_gradient_of(const Lighting& lighting) {
    const int exponent = std::ilogb(*lighting.smallest_gradient);
    return {static_cast<float>(std::ldexp(*lighting.smallest_gradient, -exponent)), exponent};
}

// Thresholds at which lit pieces of rays are cut.
struct LightCuts {
    // Largest distance of the gradient from that in the middle of a piece, as a share of its length
    // there. Beyond it there may be highlights of up to `highlight_effect` between the nodes, and
    // dips of everything else.
    double most_turn = 0, highlight_effect = 0;
    double most_plain_turn = 0, plain_effect = 0;

    double largest_effect() const { return highlight_effect + plain_effect; }
};

// Share of the largest bend that may remain in faint pieces. A ray has a few of these under light
// of strength 1, and more under stronger light. The shaders use their own: 1/4
// (slicing/cell_light.glsl, projection/light_along.glsl).
inline constexpr double faint_share_of_cells = 1.0 / 2, faint_share_of_tets = 1.0 / 4;

LightCuts light_cuts(const Lighting& lighting);

// A lighting as vectors compute it, in three orthogonal axes.
struct CpuLight {
    struct Direction {
        bool to_eye = false;  // a headlight
        std::array<float, 3> to_light{};
        std::array<float, 3> color{};
        float largest_color = 0;
    };
    std::vector<Direction> directions;
    bool gray = false;  // all components of each colour are equal
    float ambient = 0, diffuse = 0, specular = 0;
    float half_power = 0;      // of the square of a cosine
    int whole_half_power = 0;  // half_power if it is a whole number, else 0
    SmallestGradient smallest;
    std::array<float, 3> spacing{};  // lengths of the axes
    // Bend of light along a piece of a ray above which the piece is cut ...
    float most_bend = 0;
    // ... unless the bend times the piece's opacity is below this: too faint to matter.
    float faint_bend = 0;
    // Largest distance of the gradient from that in the middle of a piece, as a share of its length
    // there; beyond it, there may be highlights between the nodes, and dips of everything else
    // (executors/lights.h).
    float most_turn = 0, highlight_effect = 0;
    float most_plain_turn = 0, plain_effect = 0;
};

// `axes`: orthogonal, in the unit of lengths along rays.
CpuLight make_tile_light(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                         double most_bend, double faint_share);

}  // namespace lamina

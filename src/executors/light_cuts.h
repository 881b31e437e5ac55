// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/lighting.h"

namespace lamina {

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

}  // namespace lamina

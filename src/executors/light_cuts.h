// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/lighting.h"

namespace lamina {

// Where lit parts of rays are cut.
struct LightCuts {
    // Of the gradient's length in the middle of a part, how far it may be from that: beyond, there
    // may be highlights of up to this effect between the nodes, and dips of all else.
    double most_turn = 0, highlight_effect = 0;
    double most_plain_turn = 0, plain_effect = 0;

    double largest_effect() const { return highlight_effect + plain_effect; }
};

// Of the largest bend, what may be left of parts that are faint: a ray has a few of them under
// light of strength 1, and the more the stronger it is.
// The shaders have their own: 1/4 (slicing/cell_light.glsl, projection/light_along.glsl).
inline constexpr double faint_share_of_cells = 1.0 / 2, faint_share_of_tets = 1.0 / 4;

LightCuts light_cuts(const Lighting& lighting);

}  // namespace lamina

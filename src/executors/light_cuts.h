// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/lighting.h"

namespace lamina {

// Where lit parts of rays are cut.
struct LightCuts {
    // Of the gradient's length in the middle of a part, how far it may be from that: beyond, there
    // may be dips and highlights between the nodes, of up to the largest effect that light has.
    double most_turn = 0, largest_effect = 0;
};

LightCuts light_cuts(const Lighting& lighting);

}  // namespace lamina

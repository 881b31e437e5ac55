// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

#include "executors/smallest_gradient.h"
#include "lamina/lighting.h"

namespace lamina {

// A lighting as vectors compute it, in three orthogonal axes.
struct TileLight {
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
    int whole_half_power = 0;  // the same where it is a whole number, else 0
    SmallestGradient smallest;
    std::array<float, 3> spacing{};  // lengths of the axes
    // Where light bends more along a part of a ray than this, the part is cut.
    float most_bend = 0;
    // Unless it bends, times the part's opacity, by less than this: too faint to be looked at.
    float faint_bend = 0;
    // Of the gradient's length in the middle of a part, how far it may be from that: beyond, there
    // may be highlights between the nodes, and dips of all else (executors/light_cuts.h).
    float most_turn = 0, highlight_effect = 0;
    float most_plain_turn = 0, plain_effect = 0;
};

// `axes`: orthogonal, in the unit of lengths along rays.
TileLight make_tile_light(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                          double most_bend, double faint_share);

}  // namespace lamina

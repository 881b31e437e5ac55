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
    int whole_half_power = 0;  // half_power if it is a whole number, else 0
    SmallestGradient smallest;
    std::array<float, 3> spacing{};  // lengths of the axes
    // Bend of light along a piece of a ray above which the piece is cut ...
    float most_bend = 0;
    // ... unless the bend times the piece's opacity is below this: too faint to matter.
    float faint_bend = 0;
    // Largest distance of the gradient from that in the middle of a piece, as a share of its length
    // there; beyond it, there may be highlights between the nodes, and dips of everything else
    // (executors/light_cuts.h).
    float most_turn = 0, highlight_effect = 0;
    float most_plain_turn = 0, plain_effect = 0;
};

// `axes`: orthogonal, in the unit of lengths along rays.
TileLight make_tile_light(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                          double most_bend, double faint_share);

}  // namespace lamina

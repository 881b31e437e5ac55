// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>

#include "projection/fan_geometry.h"

namespace lamina {

// One of the paper's triangles (projection/fan_geometry.h) as a rasteriser has it: its corners are
// rounded to 1/256 pixel, and what is known of them is interpolated linearly between these.
struct TriangleRecord {
    // Twice the area of a pixel centre's triangle with the edge, >= 0 on the inner side. Both
    // triangles that share an edge compute the same number with the opposite sign.
    struct Edge {
        double column, row;          // a corner, window coordinates
        double per_column, per_row;  // change from there
        bool has_zeros;              // pixel centres on the edge are this triangle's
    };
    struct Corner {
        glm::vec3 inverse;  // as in FanVertex
        glm::vec4 front, back;
    };
    std::array<Edge, 3> edges;  // opposite the corners, which are rounded to the grid
    // A corner's share of what is interpolated: linear in the pixel, between corners that are not
    // rounded, as rasterisers do it.
    struct Share {
        double column, row;  // where it is 0
        double per_column, per_row;
    };
    std::array<Share, 3> shares;
    std::array<Corner, 3> corners;
    glm::vec2 scalars;     // as in FanVertex
    std::uint32_t number;  // of the tet, for dithering
};

// False where the triangle covers nothing.
bool make_triangle(const std::array<const FanVertex*, 3>& vertices, TriangleRecord& record);

// Where corners are rounded to.
glm::dvec2 rounded_to_grid(const glm::vec2& window);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>

#include "projection/fan_geometry.h"

namespace lamina {

// A triangle of Kraus 2004 (projection/fan_geometry.h) as a rasteriser treats it. Its corners are
// rounded to 1/256 pixel, and values are interpolated linearly between them.
struct TriangleRecord {
    // Twice the area of the triangle of an edge and a pixel centre, >= 0 on the inner side. Two
    // triangles that share an edge compute the same number with opposite signs.
    struct Edge {
        double column, row;          // a corner of the edge, window coordinates
        double per_column, per_row;  // change of the area from that corner
        bool has_zeros;              // pixel centres on the edge belong to this triangle
    };
    struct Corner {
        glm::vec3 inverse;  // as in FanVertex
        glm::vec4 front, back;
    };
    std::array<Edge, 3> edges;  // opposite the corners; these are rounded to the grid
    // The weight of a corner in the interpolation. It is linear in the pixel between corners that
    // are not rounded, as in rasterisers.
    struct Share {
        double column, row;  // place at which it is 0
        double per_column, per_row;
    };
    std::array<Share, 3> shares;
    std::array<Corner, 3> corners;
    glm::vec2 scalars;     // as in FanVertex
    std::uint32_t number;  // number of the tet, for dithering
};

// Fills the record. Returns false if the triangle covers nothing.
bool make_triangle(const std::array<const FanVertex*, 3>& vertices, TriangleRecord& record);

// Returns the point of the rasteriser's grid to which a corner is rounded.
glm::dvec2 rounded_to_grid(const glm::vec2& window);

}  // namespace lamina

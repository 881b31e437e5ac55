// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// One tet of one view as shaders/projection/silhouette.vert reads it, 9 uvec4.
//
// `Depth` is z in orthographic views and -1/z in perspective ones: it grows with eye-space depth z
// and is linear in window coordinates on every plane (Kraus 2004, section 2.1). A ray is inside the
// tet from the largest depth on faces that the eye is in front of to the least on all others.
struct alignas(16) TetRecord {
    // A double as the sum of two floats, for the four faces.
    struct Pairs {
        std::array<float, 4> high, low;
    };
    // On the plane of each face, the front faces first: depth at `center` less `center_depth`, and
    // its change per pixel to the right and upwards.
    Pairs depth, depth_per_column, depth_per_row;
    std::array<float, 2> center;  // a pixel centre near the tet, window coordinates
    float center_depth;           // somewhere in the tet
    float center_z;               // the same as z
    // The scalar at that point, normalised; its change along the ray there per unit of z, and per
    // pixel at z = 1 (perspective), or per pixel.
    float scalar, scalar_per_z, scalar_per_column, scalar_per_row;
    float least_scalar, largest_scalar;  // of the corners
    std::uint32_t fronts;                // 0 (the eye is inside) to 3
    std::uint32_t tet;
};
static_assert(sizeof(TetRecord) == 144);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// Indices of the four corners (a, b, c, d) of a tet. A tet is positively oriented: det(b - a, c -
// a, d - a) > 0.
using Tet = std::array<std::int32_t, 4>;

// Face i of a tet lies opposite corner i. Its corners are counter-clockwise seen from outside the
// (positively oriented) tet.
inline constexpr std::array<std::array<std::size_t, 3>, 4> face_corners{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// One face of one tet.
struct TetFace {
    std::int32_t tet = 0;
    std::int32_t face = 0;
};

inline std::array<std::int32_t, 3> corners_of_face(const Tet& tet, std::size_t face) {
    const auto& corner = face_corners[face];
    return {tet[corner[0]], tet[corner[1]], tet[corner[2]]};
}

}  // namespace lamina

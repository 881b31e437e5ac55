// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamina/tet.h"

namespace lamina {

// The tet across each face, found by corner indices alone. Faces of three or more tets have no tet
// across.
struct FaceMatching {
    // Tet across face i; -1 where there is none.
    std::vector<std::array<std::int32_t, 4>> neighbors;
    // Tets with the same corners as an earlier tet, ascending.
    std::vector<std::int32_t> duplicates;
    std::int64_t boundary_faces = 0;     // number of faces of one tet
    std::int64_t nonmanifold_faces = 0;  // number of faces of three or more tets
};

// Matches faces by sorting, on all cores, with 48 bytes a tet of working memory. `tets`: four
// different corners each, all in [0, point_count); fewer than 2^29 tets.
FaceMatching match_faces(std::span<const Tet> tets, std::size_t point_count);

}  // namespace lamina

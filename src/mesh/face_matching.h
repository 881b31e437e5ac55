// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamina/tet.h"

namespace lamina {

// Which tet lies across each face, by corner indices alone; faces of three or more tets have
// nobody across.
struct FaceMatching {
    std::vector<std::array<std::int32_t, 4>> neighbors;  // across face i; -1 where there is none
    std::vector<std::int32_t> duplicates;  // tets with the corners of an earlier one, ascending
    std::int64_t boundary_faces = 0;       // of one tet
    std::int64_t nonmanifold_faces = 0;    // of three or more tets
};

// `tets`: four different corners each, all in [0, point_count); fewer than 2^29 tets. By sorting,
// on all cores, with 48 bytes a tet on the way.
FaceMatching match_faces(std::span<const Tet> tets, std::size_t point_count);

}  // namespace lamina

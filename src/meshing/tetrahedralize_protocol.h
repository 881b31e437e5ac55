// SPDX-License-Identifier: Apache-2.0
// The messages between lamina and its helper program lamina-tetrahedralize, in native byte order.
//
// Question (stdin): int64 number of points n, n * 3 doubles (x, y, z).
// Answer (stdout):   int64 number of tets m, m * 4 int32 corners, m * 4 int32 neighbours.
//
// Corners count from 0 and are positively oriented (lamina/mesh.h); neighbour i is the tet opposite
// corner i, -1 on the hull. Points that equal an earlier one are in no tet. If the answer does not
// have that length, the question has failed: the exit code is then not 0, and stderr says why.
//
// `--parent PID`: the process that asks. The helper ends at once when the thread that started it
// ends, or when PID is no longer its parent, so it does not outlive a lamina that was killed.
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

inline constexpr const char* tetrahedralize_program = "lamina-tetrahedralize";

inline constexpr const char* tetrahedralize_parent_option = "--parent";
inline constexpr int tetrahedralize_no_room = 4;  // exit code: the answer could not be written

using TetrahedralizeCount = std::int64_t;
using TetrahedralizePoint = std::array<double, 3>;
using TetrahedralizeTet = std::array<std::int32_t, 4>;

}  // namespace lamina

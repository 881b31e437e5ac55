// SPDX-License-Identifier: Apache-2.0
// Tetrahedra that fill a layered box, with its scalar at their corners, in ways that try a
// renderer.
#pragma once

#include <cstdint>

#include "lamina/mesh_data.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {

// Every layer cut into across x across cuboids, six tets each (Kuhn).
MeshData kuhn_tets(const LayeredBox& box, int across);

// For one layer: 12 * across^2 tets from the middle of the box to its surface, which all have that
// point.
MeshData fan_tets(const LayeredBox& box, int across);

// For one layer: kuhn_tets(box, 1), split `splits` times by a point inside a tet which is a share
// `least` or less away from a face, an edge or a corner of it: flat tets, slivers and needles.
MeshData split_tets(const LayeredBox& box, int splits, double least, std::uint32_t seed);

// The same mesh with tets, their corners and the points in another order.
MeshData shuffled(const MeshData& mesh, std::uint32_t seed);

}  // namespace lamina::selftest

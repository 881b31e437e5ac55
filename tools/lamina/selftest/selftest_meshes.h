// SPDX-License-Identifier: Apache-2.0
// Meshes that fill a layered box, with its scalar at their corners, and that are hard for a
// renderer.
#pragma once

#include <cstdint>

#include "lamina/mesh_data.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {

// Every layer is cut into across x across cuboids, six tets each (Kuhn).
MeshData kuhn_tets(const LayeredBox& box, int across);

// For a box of one layer: 12 * across^2 tets from the middle of the box, which is a corner of all,
// to its surface.
MeshData fan_tets(const LayeredBox& box, int across);

// For a box of one layer: kuhn_tets(box, 1), split `splits` times by a point inside a tet. The
// point's distance from a face, an edge or a corner of the tet is a share `least` or less, which
// gives flat tets, slivers and needles.
MeshData split_tets(const LayeredBox& box, int splits, double least, std::uint32_t seed);

// The same mesh with its tets, their corners and its points in another order.
MeshData shuffled(const MeshData& mesh, std::uint32_t seed);

}  // namespace lamina::selftest

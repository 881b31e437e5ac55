// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "image/coded_image.h"
#include "mesh/tet_mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A picture of a mesh for a quick look: the open faces, shaded, in a parallel projection seen from
// direction (1, -1, 1), and cuts through the middle of its box across x, y and z. Each of the four
// is fitted into `side` x `side` pixels, in two rows. Colour follows the scalar over `range` from
// purple (lo) to yellow (hi); values that are not finite are red. Edges of faces and tets are dark
// where faces and tets cover enough pixels. `scalar`: one value a point, or empty. `side`: 16 to
// 4096.
CodedImage mesh_picture(const TetMesh& mesh, std::span<const double> scalar,
                        const ValueRange& range, int side);

}  // namespace lamina

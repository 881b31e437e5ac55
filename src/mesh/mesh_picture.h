// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "mesh/tet_mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A picture of a mesh for a quick look: the open faces, seen from (1, -1, 1), and cuts through the
// middle of its box, each in `side` (16 to 4096) pixels, in two rows. Colours go from purple
// (range.lo) to yellow; values that are not finite are red. `scalar`: one value a point, or empty.
CodedImage mesh_picture(const TetMesh& mesh, std::span<const double> scalar,
                        const ValueRange& range, int side);

}  // namespace lamina

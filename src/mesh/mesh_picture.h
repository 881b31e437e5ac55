// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "mesh/tet_mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Returns a picture for a quick look, four panels of `side` (16 to 4096) pixels squared: the open
// faces, seen from (1, -1, 1), and three cuts through the middle of the mesh's box. Colours go from
// purple (range.lo) to yellow; red: not finite. `scalar`: one value a point, or empty.
CodedImage mesh_picture(const TetMesh& mesh, std::span<const double> scalar,
                        const ValueRange& range, int side);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
// Meshes for the study of projected tetrahedra that need neither data nor TetGen.
#pragma once

#include <array>
#include <cstdint>

#include "scene/scene_mesh.h"

namespace lamina::papers {

// cells[0] x cells[1] x cells[2] cubes that fill the unit cube, six tets each (Kuhn), with a field
// of a few smooth blobs, 0 to about 1.
SceneMesh make_box_mesh(const std::array<std::int32_t, 3>& cells);

// A boundary layer, as around a body in a flow: Kuhn's tets in columns, cells x cells of them side
// by side on the unit square, whose thickness grows geometrically from the body outwards so that
// the longest edge of the mesh is `ratio` times the shortest. The body is a plate with a bump of
// that height in its middle. With the distance h from it the field falls as 1 / (1 + (h / d)^2), d
// from .001 to .003 in waves: most of it lies in the thin cells.
SceneMesh make_graded_mesh(std::int32_t cells, std::int32_t layers, double ratio, double bump);

}  // namespace lamina::papers

// SPDX-License-Identifier: Apache-2.0
// Meshes for the reproduction of Kraus 2004 that need neither data files nor TetGen.
#pragma once

#include <array>
#include <cstdint>

#include "scene/scene_mesh.h"

namespace lamina::papers {

// Makes cells[0] x cells[1] x cells[2] cubes that fill the unit cube, six tets each (Kuhn), with a
// field of a few smooth blobs from 0 to about 1.
SceneMesh make_box_mesh(const std::array<std::int32_t, 3>& cells);

// Makes a boundary layer, as around a body in a flow. It consists of Kuhn's tets in cells x cells
// columns on the unit square. Their thickness grows geometrically away from the body, so that the
// longest edge of the mesh is `ratio` times the shortest. The body is a plate with a bump of height
// `bump` in its middle. With the distance h from it the field falls as 1 / (1 + (h / d)^2), where d
// varies between .001 and .003. So most of the field lies in the thin cells.
SceneMesh make_graded_mesh(std::int32_t cells, std::int32_t layers, double ratio, double bump);

}  // namespace lamina::papers

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/mesh_data.h"

namespace lamina {

// Reads TetGen's NAME.node and NAME.ele (`path` is one of them): counted from 0 or from 1, as the
// first point is; of 10-node tets the corners. Point attribute N gives a point scalar, attribute N
// of a tet a cell scalar. Its name is NAME where a comment line before the numbers says
// "# point attribute N: NAME" ("# tet attribute N: NAME" in the .ele), as our own files do, else
// "point attribute N" or "tet attribute N". Boundary markers are read and dropped. Throws Error.
MeshData read_node_ele(const std::filesystem::path& path);

}  // namespace lamina

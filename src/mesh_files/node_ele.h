// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/mesh_data.h"

namespace lamina {

// Reads TetGen's NAME.node and NAME.ele; `path` is one of them. Points count from 0 or from 1, as
// the first point says. Of 10-node tets only the corners are used. Point attribute N gives a point
// scalar, and attribute N of a tet a cell scalar. The scalar's name is NAME where a comment line
// before the numbers says "# point attribute N: NAME" ("# tet attribute N: NAME" in the .ele), as
// in lamina's own files. Otherwise it is "point attribute N" or "tet attribute N". Boundary markers
// are ignored. Throws Error.
MeshData read_node_ele(const std::filesystem::path& path);

}  // namespace lamina

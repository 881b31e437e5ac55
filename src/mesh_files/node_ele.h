// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/mesh_data.h"

namespace lamina {

// Reads TetGen's NAME.node and NAME.ele; `path` is one of them. Points count from 0 or from 1, as
// the first point says. Only the corners of 10-node tets are used, and boundary markers are
// ignored. Point attribute N gives a point scalar, attribute N of a tet a cell scalar. Their names
// are "point attribute N" and "tet attribute N", unless a comment line before the numbers says
// another, as in lamina's own files: "# point attribute N: NAME" ("# tet attribute N: NAME" in the
// .ele). Throws Error.
MeshData read_node_ele(const std::filesystem::path& path);

}  // namespace lamina

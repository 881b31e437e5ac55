// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "mesh/eye.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// How many shared faces an order gets wrong: the tet on the far side does not come first, by exact
// signs. `order`: every tet once, back to front. Throws Error if it is not that. Parallel.
std::int64_t face_violations(const TetMesh& mesh, const Eye& eye,
                             std::span<const std::int32_t> order);

}  // namespace lamina

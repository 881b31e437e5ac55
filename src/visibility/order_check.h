// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// Counts the shared faces that an order gets wrong, because the tet on the far side does not come
// first. Signs are exact. `order`: every tet once, back to front; otherwise throws Error. Parallel.
std::int64_t face_violations(const TetMesh& mesh, const Eye& eye,
                             std::span<const std::int32_t> order);

}  // namespace lamina

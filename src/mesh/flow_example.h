// SPDX-License-Identifier: Apache-2.0
// A mesh with the flow past a standing cylinder.
#pragma once

#include "lamina/mesh.h"

namespace lamina {

// Returns tets around a cylinder of diameter 1, z upwards, with the flow's "vorticity", "pressure"
// and "speed" at their corners. The flow looks like one with vortices behind the cylinder; it is a
// formula, and solves no equation. Parallel.
MeshData flow_mesh();

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace lamina {

// The gradient of a scalar at the points of a mesh (docs/numerics.md, section 10): of the constant
// gradients of the tets around a point the mean, weighted by their volumes, in scalar units per
// world unit. `scalar`: one value a point. Tets of no volume, and those with a value that is not
// finite, do not count; where none is left the gradient is 0.
std::vector<glm::dvec3> point_gradients(const TetMesh& mesh, std::span<const double> scalar);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lamina/tet.h"

namespace lamina {

// Positively oriented tets that fill the convex hull of points, and the neighbouring tet opposite
// each corner (-1 on the hull).
struct DelaunayTets {
    std::vector<Tet> tets;
    std::vector<std::array<std::int32_t, 4>> neighbors;
};

// A function that makes Delaunay tetrahedra of points. Throws Error.
using Delaunay = std::function<DelaunayTets(std::span<const glm::dvec3>)>;

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include "lamina/mesh.h"

namespace lamina {

// Positive tets that fill the convex hull, and the tet opposite each corner (-1 on the hull).
struct DelaunayTets {
    std::vector<Tet> tets;
    std::vector<std::array<std::int32_t, 4>> neighbors;
};

using Delaunay = std::function<DelaunayTets(std::span<const glm::dvec3>)>;

// Finds lamina-tetrahedralize as find_program() does. Throws Error, which says how to get it, if it
// is not there.
std::filesystem::path require_tetrahedralizer();

// Runs `program` (meshing/tetrahedralize_protocol.h) with temporary files for its input and output.
// Throws Error if it cannot be started, fails, or does not answer. Ctrl-C ends it.
DelaunayTets delaunay_by_process(const std::filesystem::path& program,
                                 std::span<const glm::dvec3> points);

}  // namespace lamina

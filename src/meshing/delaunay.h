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

// Positive tets that fill points' convex hull. Neighbour i lies opposite corner i (-1: none).
struct DelaunayTets {
    std::vector<Tet> tets;
    std::vector<std::array<std::int32_t, 4>> neighbors;
};

using Delaunay = std::function<DelaunayTets(std::span<const glm::dvec3>)>;

// Returns lamina-tetrahedralize's path (find_program()). Throws Error, with advice, if missing.
std::filesystem::path require_tetrahedralizer();

// Starts `program` (meshing/tetrahedralize_protocol.h), with temporary files for its input and
// output. Throws Error if it cannot be started, fails, or does not answer. Ctrl-C ends it.
DelaunayTets delaunay_by_process(const std::filesystem::path& program,
                                 std::span<const glm::dvec3> points);

}  // namespace lamina

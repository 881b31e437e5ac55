// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
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

// Finds the program lamina-tetrahedralize: beside the running program, or among the programs
// installed with the library, or else in one of the folders of PATH.
std::optional<std::filesystem::path> find_tetrahedralizer();

// Returns that path. Throws Error, which says how to get the program, if it is not found.
std::filesystem::path require_tetrahedralizer();

// Makes Delaunay tetrahedra with `program` (meshing/tetrahedralize_protocol.h), which runs as a
// separate process with temporary files for its input and output. Throws Error if it cannot be
// started, fails, or does not answer. Ctrl-C ends it.
DelaunayTets delaunay_by_process(const std::filesystem::path& program,
                                 std::span<const glm::dvec3> points);

}  // namespace lamina

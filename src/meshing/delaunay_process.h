// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "meshing/delaunay.h"

namespace lamina {

// The program lamina-tetrahedralize: beside the running program, else in one of the folders of
// PATH.
std::optional<std::filesystem::path> find_tetrahedralizer();

// As above; throws Error that says how to get it.
std::filesystem::path require_tetrahedralizer();

// Delaunay tetrahedra by `program` (meshing/tetrahedralize_protocol.h), run as a process of its own
// with temporary files for its input and output. Throws Error when it cannot be started, fails, or
// does not answer; Ctrl-C ends it.
DelaunayTets delaunay_by_process(const std::filesystem::path& program,
                                 std::span<const glm::dvec3> points);

}  // namespace lamina

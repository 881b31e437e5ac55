// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lamina/mesh_data.h"

namespace lamina {

// One step of a .pvd file (ParaView's list of the files of a mesh that changes with time).
struct PvdStep {
    double time = 0;
    std::vector<std::filesystem::path> files;  // .vtu or .pvtu, the parts of the mesh
};

// The steps of a .pvd file in the order of their times. Throws Error.
std::vector<PvdStep> steps_of_pvd(const std::filesystem::path& path);

// Reads and joins the files of one step, the first of which is 0. Throws Error, also where there
// is no such step.
MeshData read_pvd(const std::filesystem::path& path, std::int64_t step);

}  // namespace lamina

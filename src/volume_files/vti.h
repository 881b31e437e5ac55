// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"

namespace lamina {

// A VTK XML file of image data.
bool is_vti(const std::filesystem::path& path);

// Reads the request's array, else the one that its piece calls Scalars, else the first; arrays of
// points before those of cells. Points are nodes; cells are cells, whose samples lie in their
// middles. Components are channels. Pieces are put together. Throws Error.
Volume read_vti(const std::filesystem::path& path, const VolumeRequest& request);

std::vector<std::filesystem::path> files_of_vti(const std::filesystem::path& path);

}  // namespace lamina

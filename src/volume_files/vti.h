// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells a VTK XML file of image data by its content.
bool is_vti(const std::filesystem::path& path);

// Reads the request's array, else the one that its piece calls Scalars, else the first; arrays of
// points come before those of cells. Points are nodes; cells are cells, whose samples lie in their
// middles. Components are channels. Pieces are put together. Throws Error.
Volume open_vti(const std::filesystem::path& path, const VolumeRequest& request = {},
                const VolumeUse& use = {});

}  // namespace lamina

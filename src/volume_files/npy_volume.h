// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// By its magic string.
bool is_npy(const std::filesystem::path& path);

// Reads NumPy's format (NEP 1): an array [z, y, x] of any real type, byte order and memory order.
// Samples lie 1 apart from 0 on, as nodes. Throws Error.
Volume read_npy_volume(const std::filesystem::path& path, const VolumeRequest& request);
// The same; the volume may stay in its file.
Volume open_npy_volume(const std::filesystem::path& path, const VolumeRequest& request,
                       const VolumeUse& use);

std::vector<std::filesystem::path> files_of_npy(const std::filesystem::path& path);

}  // namespace lamina

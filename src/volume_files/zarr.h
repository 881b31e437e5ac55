// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells if the path is a folder with a Zarr array, group or image.
bool is_zarr(const std::filesystem::path& path);

// Reads an array of Zarr version 2, or a level of an OME-Zarr image. A plain array has the axes z,
// y, x, before these the channel, before that the time; its samples are 1 apart. If the folder is a
// group, `request.array` names an array or image in it; else it must have only one. Throws Error.
Volume open_zarr(const std::filesystem::path& path, const VolumeRequest& request = {},
                 const VolumeUse& use = {});

// Returns all files of the folder.
std::vector<std::filesystem::path> files_of_zarr(const std::filesystem::path& path);

}  // namespace lamina

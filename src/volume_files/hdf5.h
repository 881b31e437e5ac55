// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells if the path is an HDF5 file (NetCDF-4 is one), or names an array in one: "FILE.h5:/PATH".
bool is_hdf5(const std::filesystem::path& path);

// Reads a three-dimensional array of numbers, in the order z, y, x; before these may come the
// channel, and before that the time. The path names the array, or `request.array`; else it is the
// only one of three dimensions or more. Distances and places come from dimension scales (NetCDF's
// coordinate variables) or the attribute element_size_um; the attributes scale_factor and
// add_offset are applied, and such a volume does not stay in its file. libhdf5 runs in a process of
// its own (volume_files/isolated_process.h). Throws Error.
Volume open_hdf5(const std::filesystem::path& path, const VolumeRequest& request = {},
                 const VolumeUse& use = {});

std::vector<std::filesystem::path> files_of_hdf5(const std::filesystem::path& path);

}  // namespace lamina

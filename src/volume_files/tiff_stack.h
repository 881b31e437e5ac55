// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"

namespace lamina {

// A TIFF or BigTIFF file, or a folder with such files in it.
bool is_tiff_stack(const std::filesystem::path& path);

// Reads pages of one size and type as slices from the first to the last: those of one file, or of
// the files of a folder, in the order of the numbers in their names. Integers of 8 to 64 bits and
// floats of 32 and 64, in strips or tiles, of every compression that libtiff knows. Samples of a
// pixel are channels; ImageJ's and OME's descriptions tell channels, times and distances. Samples
// are nodes. Throws Error.
Volume read_tiff_stack(const std::filesystem::path& path, const VolumeRequest& request);

std::vector<std::filesystem::path> files_of_tiff_stack(const std::filesystem::path& path);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells a TIFF or BigTIFF file, or a folder with such files in it, by the first bytes.
bool is_tiff(const std::filesystem::path& path);

// Reads pages of one size and type as slices from the first to the last: those of one file, or of
// the files of a folder, in the order of the numbers in their names. Integers of 8 to 64 bits and
// floats of 32 and 64, in strips or tiles, with every compression that libtiff knows. The samples
// of a pixel are channels; ImageJ's and OME's descriptions give channels, times and distances.
// Samples are nodes. Throws Error.
Volume open_tiff(const std::filesystem::path& path, const VolumeRequest& request = {},
                 const VolumeUse& use = {});

// Returns the file, or the TIFF files of the folder.
std::vector<std::filesystem::path> files_of_tiff(const std::filesystem::path& path);

}  // namespace lamina

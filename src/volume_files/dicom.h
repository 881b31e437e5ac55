// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells if the path is a DICOM file, or a folder with one among its first files.
bool is_dicom(const std::filesystem::path& path);

// Reads one series of a folder, or a file of several frames: the largest series unless
// request.array names another by its UID or description; and the request's time of a series that
// has several images at each place. Samples are what RescaleSlope and RescaleIntercept make of the
// pixels. Throws Error, also if slices are missing or do not go together.
Volume open_dicom(const std::filesystem::path& path, const VolumeRequest& request = {},
                  const VolumeUse& use = {});

// Returns the folder's files, or the file.
std::vector<std::filesystem::path> files_of_dicom(const std::filesystem::path& path);

}  // namespace lamina

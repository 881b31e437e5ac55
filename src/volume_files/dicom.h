// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"

namespace lamina {

// Whether the path is a DICOM file, or a folder with one among its first files.
bool is_dicom(const std::filesystem::path& path);

// Reads the series of a folder, or a file of several frames: volume_files/dicom_series.h. Samples
// are what RescaleSlope and RescaleIntercept make of the pixels. Throws Error.
Volume read_dicom(const std::filesystem::path& path, const VolumeRequest& request);

// The folder's files.
std::vector<std::filesystem::path> files_of_dicom(const std::filesystem::path& path);

}  // namespace lamina

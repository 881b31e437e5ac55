// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lamina/grid.h"
#include "lamina/volume_request.h"
#include "volume_files/dicom_image.h"

namespace lamina {

// The images of one volume, from the first slice to the last, and where their pixels lie.
struct DicomSeries {
    std::string name;  // for messages
    std::vector<DicomImage> slices;
    Grid grid;
};

// The series of a folder's files, or of a file: the largest unless request.array names another by
// its UID or description; and of a series that has several images at each place the request's time.
// Throws Error where slices are missing, or do not go together.
DicomSeries read_dicom_series(const std::filesystem::path& path, const VolumeRequest& request);

}  // namespace lamina

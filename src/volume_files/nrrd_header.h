// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/grid.h"
#include "lamina/volume_request.h"
#include "volume_files/stored_data.h"

namespace lamina {

// The contents of the header of a NRRD file. Only the header has been read.
struct NrrdHeader {
    Grid grid;
    StoredData data;
};

NrrdHeader read_nrrd_header(const std::filesystem::path& path, const VolumeRequest& request = {});

}  // namespace lamina

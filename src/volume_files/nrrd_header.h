// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/value_type.h"
#include "lamina/grid.h"
#include "lamina/volume_request.h"
#include "volume_files/stored_axes.h"

namespace lamina {

enum class NrrdEncoding { raw, ascii, gzip, bzip2 };

// The contents of the header of a NRRD file, and the place of its samples. Only the header has been
// read.
struct NrrdHeader {
    std::filesystem::path path;  // the file that the user named
    Grid grid;
    ValueType type = ValueType::uint8;
    std::vector<StoredAxis> axes;  // of the data, and what of them makes the grid's samples
    NrrdEncoding encoding = NrrdEncoding::raw;
    bool swap_bytes = false;  // the samples are not in this machine's byte order
    // At least one; `path` itself where the header is attached. All hold the same number of
    // samples.
    std::vector<std::filesystem::path> data_paths;
    std::int64_t data_offset = 0;  // bytes to skip first in each
    std::int64_t line_skip = 0;    // lines to skip next
    // Bytes to skip last, of the decompressed stream. -1 - n means raw data that end n bytes before
    // the end of the file.
    std::int64_t byte_skip = 0;
};

NrrdHeader read_nrrd_header(const std::filesystem::path& path, const VolumeRequest& request = {});

}  // namespace lamina

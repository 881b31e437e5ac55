// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "lamina/grid.h"
#include "lamina/volume.h"

namespace lamina {

enum class NrrdEncoding { raw, ascii, gzip, bzip2 };

// The contents of the header of a NRRD file, and the place of its samples. Only the header has been
// read.
struct NrrdHeader {
    std::filesystem::path path;  // the file that the user named
    Grid grid;
    SampleType type = SampleType::uint8;
    NrrdEncoding encoding = NrrdEncoding::raw;
    bool swap_bytes = false;          // the samples are not in this machine's byte order
    std::filesystem::path data_path;  // `path` itself where the header is attached
    std::int64_t data_offset = 0;     // bytes to skip first in data_path
    std::int64_t line_skip = 0;       // lines to skip next
    // Bytes to skip last, of the decompressed stream. -1 - n means raw data that end n bytes before
    // the end of the file.
    std::int64_t byte_skip = 0;
};

NrrdHeader read_nrrd_header(const std::filesystem::path& path);

}  // namespace lamina

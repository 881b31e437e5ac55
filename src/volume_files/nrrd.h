// SPDX-License-Identifier: Apache-2.0
#pragma once
// NRRD files (http://teem.sourceforge.net/nrrd/format.html). World coordinates are the file's own:
// `space origin` (or axis min) is the position of the first sample, and `space directions` (or
// `spacings`) are the steps between samples.

#include <filesystem>
#include <vector>

#include "lamina/grid.h"
#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/stored_data.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells a NRRD file by its magic number.
bool is_nrrd(const std::filesystem::path& path);

// Reads three orthogonal axes of samples of any scalar type. Beyond three, axes of one sample are
// dropped; the header's kinds and directions must identify the others, which are the request's
// channel and time. Encodings are raw, gzip, bzip2 and ascii; the header is attached or names its
// data files; both byte orders are read. The sizes in the header are checked against the files'
// lengths before memory is taken. NaN and infinite samples are kept. Throws Error, one line that
// names the file.
Volume open_nrrd(const std::filesystem::path& path, const VolumeRequest& request = {},
                 const VolumeUse& use = {});

// Returns the file and its data files. Throws Error.
std::vector<std::filesystem::path> files_of_nrrd(const std::filesystem::path& path);

// The contents of the header of a NRRD file.
struct NrrdHeader {
    Grid grid;
    StoredData data;
};

// Reads the header alone. Throws Error.
NrrdHeader read_nrrd_header(const std::filesystem::path& path, const VolumeRequest& request = {});

}  // namespace lamina

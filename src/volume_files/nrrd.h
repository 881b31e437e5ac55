// SPDX-License-Identifier: Apache-2.0
// NRRD files (http://teem.sourceforge.net/nrrd/format.html). World coordinates are the file's own:
// `space origin` (or axis min) is the position of the first sample, and `space directions` (or
// `spacings`) are the steps between samples.
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// By its magic number.
bool is_nrrd(const std::filesystem::path& path);

// Reads three orthogonal axes of samples of any scalar type. Of axes beyond three those of one
// sample are dropped; the header's kinds and directions must tell the others, which are the
// request's channel and time. Encodings are raw, gzip, bzip2 and ascii; the header is attached or
// names its data files; both byte orders are read. The sizes in the header are checked against the
// files' lengths before memory is taken. NaN and infinite samples are kept. Throws Error, one line
// that names the file.
Volume read_nrrd(const std::filesystem::path& path, const VolumeRequest& request = {});

// The file and its data files. Throws Error.
// The same; it may stay in its files (volume_files/volume_opening.h).
Volume open_nrrd(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use);

std::vector<std::filesystem::path> files_of_nrrd(const std::filesystem::path& path);

}  // namespace lamina

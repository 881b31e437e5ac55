// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/output_file.h"
#include "lamina/image.h"

namespace lamina {

// Writes channels R, G, B, A as 32-bit float with ZIP compression, and the attributes as strings.
// There is no time stamp: equal images make equal files. Throws Error where a component is not
// finite or the disk is full. The caller commits the file.
void write_exr(OutputFile& file, const Image& image,
               const std::map<std::string, std::string>& attributes);

// Reads the data window of the first part, which must be flat, with any pixel type. A missing A
// becomes 1, and a file with only Y is grey. Throws Error for anything else that lacks R, G or B,
// for damaged files and for sizes beyond image_limits.h.
Image read_exr(const std::filesystem::path& path);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/atomic_file.h"
#include "lamina/image.h"

namespace lamina {

// Channels R, G, B, A, 32-bit float, ZIP, the attributes as strings, no time stamp: equal images
// make equal files. Throws Error when a component is not finite or the disk is full. The caller
// commits the file.
void write_exr(AtomicFile& file, const Image& image,
               const std::map<std::string, std::string>& attributes);

// The data window of a (first) flat part, any pixel type. A missing A is 1; a file with Y alone is
// grey; anything else that lacks R, G or B throws Error, as do damaged files and sizes beyond
// image_limits.h.
Image read_exr(const std::filesystem::path& path);

}  // namespace lamina

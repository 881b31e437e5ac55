// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/output_file.h"
#include "lamina/image.h"

namespace lamina {

// Writes channels R, G, B, A as 32-bit float with ZIP compression, and the attributes as strings;
// "color_space" of "display" marks display values. No time stamp: equal images make equal files.
// Throws Error if a component is not finite or the disk is full. The caller commits the file.
void write_exr(OutputFile& file, const Image& image,
               const std::map<std::string, std::string>& attributes,
               ImageColorSpace space = ImageColorSpace::linear);

// Reads the data window of the first part, which must be flat, with R, G, B and perhaps A, else 1,
// or Y, which is grey. Throws Error for others, damaged files and sizes beyond image_limits.h.
Image read_exr(const std::filesystem::path& path);

// Tells whether the numbers of a file that read_exr() reads are linear light or display values.
ImageColorSpace color_space_of_exr(const std::filesystem::path& path);

}  // namespace lamina

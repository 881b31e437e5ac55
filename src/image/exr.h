// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/output_file.h"
#include "lamina/image.h"

namespace lamina {

// Writes R, G, B, A as 32-bit float with ZIP compression, annotations as the layer "annotation",
// and the attributes as strings
// ("color_space" "display": display values), without a time stamp: equal images make equal files.
// Throws Error if a component is not finite or the disk is full. The caller commits the file.
void write_exr(OutputFile& file, const Image& image,
               const std::map<std::string, std::string>& attributes,
               ImageColorSpace space = ImageColorSpace::linear);

// Reads the data window of a file's first part, which must be flat and have R, G, B, or Y for grey;
// A is 1 if absent. Throws Error for other or damaged files and sizes beyond image_limits.h.
Image read_exr(const std::filesystem::path& path);

// Returns the colour space of the numbers that read_exr() reads: linear light or display values.
ImageColorSpace color_space_of_exr(const std::filesystem::path& path);

// Returns the attribute that write_exr() wrote under this name; nothing if there is none.
std::optional<std::string> attribute_of_exr(const std::filesystem::path& path,
                                            const std::string& name);

}  // namespace lamina

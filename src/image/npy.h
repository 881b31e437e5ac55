// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/output_file.h"
#include "lamina/image.h"

namespace lamina {

// Writes NumPy's format (NEP 1), version 1.0: float32 or float64 as the image has them, little
// endian, C order, shape (height, width, 4). Throws Error where a component is not finite or the
// disk is full. The caller commits the file.
void write_npy(OutputFile& file, const Image& image);
void write_npy(OutputFile& file, const PreciseImage& image);

// Reads '<f4' or '<f8' in C order with shape (height, width, 4), or (height, width, 3) with A = 1.
// Throws Error for anything else, and where the file's length does not match the header.
PreciseImage read_npy(const std::filesystem::path& path);

}  // namespace lamina

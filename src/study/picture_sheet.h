// SPDX-License-Identifier: Apache-2.0
// Several pictures on one sheet, to look at.
#pragma once

#include <filesystem>
#include <vector>

#include "image/coded_image.h"
#include "lamina/image.h"

namespace lamina::study {

// As write_png shows it on black: 8-bit sRGB codes, three channels.
CodedImage shown(const Image& image);

// One PNG: rows of pictures side by side, white between them. All are RGB of 8 bits and of one
// size; rows may differ in length.
void write_sheet(const std::filesystem::path& path,
                 const std::vector<std::vector<CodedImage>>& rows);

// A sheet of one row, on black.
void write_pictures(const std::filesystem::path& path, const std::vector<Image>& pictures);

}  // namespace lamina::study

// SPDX-License-Identifier: Apache-2.0
// Sheets of several pictures for people to look at.
#pragma once

#include <filesystem>
#include <vector>

#include "image/coded_image.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina::study {

// The picture as write_png shows it on black: 8-bit sRGB codes, three channels.
CodedImage shown(const Image& image, ImageColorSpace space = ImageColorSpace::linear);

// Writes one PNG with rows of pictures side by side and white gaps. All pictures are RGB of 8 bits
// and have one size. Rows may differ in length.
void write_sheet(const std::filesystem::path& path,
                 const std::vector<std::vector<CodedImage>>& rows);

// Writes a sheet of one row, on black.
void write_pictures(const std::filesystem::path& path, const std::vector<Image>& pictures);

}  // namespace lamina::study

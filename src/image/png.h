// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/output_file.h"
#include "image/coded_image.h"
#include "lamina/image.h"

namespace lamina {

// A picture as codes to look at, and the number of its pixels that were clamped by more than 1/510
// in some channel; smaller excesses are rounding of a low-precision target.
struct CodedPicture {
    CodedImage codes;
    std::size_t clamped_pixels = 0;
};

// Returns the codes that PNG files, screens and films show, annotations included: C + (1-A) *
// background or, if the look is transparent, C/A with the opacity A as straight alpha; clamped to
// 0..1, encoded to sRGB if it is linear light. A transparent picture is clamped if C exceeds A.
// `name`: for messages. Throws Error for numbers that are not finite.
CodedPicture coded_picture(const std::string& name, const Image& image, const PngLook& look,
                           ImageColorSpace space);

// Writes the codes of coded_picture() with an sRGB chunk and no time stamp. Returns the number of
// clamped pixels. Throws Error as write_exr() does. The caller commits the file.
std::size_t write_png(OutputFile& file, const Image& image, const PngLook& look,
                      ImageColorSpace space = ImageColorSpace::linear);

// Writes the codes unchanged, marked as sRGB.
void write_png(OutputFile& file, const CodedImage& image);

// Return the bytes of the file that write_png() writes.
std::string encode_png(const CodedImage& image);
std::string encode_png(const Image& image, const PngLook& look, ImageColorSpace space);

// Reads a PNG file's codes; palettes and grey of fewer than 8 bits are expanded to 8 bits, and a
// transparent colour becomes alpha. Throws Error for damaged files and sizes beyond image_limits.h.
CodedImage read_png(const std::filesystem::path& path);

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "image/coded_image.h"
#include "lamina/image.h"

namespace lamina {

// Returns the picture with its annotations laid over it, or the picture itself if it has none.
// `shown`: memory for the result.
const Image& with_annotations(const Image& picture, Image& shown);

// Writes a picture to look at, with its annotations: C + (1-A) * background, clamped to 0..1, encoded to sRGB if it is
// linear light, as 8-bit RGB with an sRGB chunk and no time stamp. Returns how many pixels were
// clamped by more than 1/510 in some channel; smaller excesses are rounding of a low-precision
// target. Throws Error as write_exr() does. The caller commits the file.
std::size_t write_png(OutputFile& file, const Image& image, const glm::dvec3& background,
                      ImageColorSpace space = ImageColorSpace::linear);

// Writes the codes unchanged, marked as sRGB.
void write_png(OutputFile& file, const CodedImage& image);

// Return the bytes of a PNG file of 8-bit RGB: for an image, the codes of write_png().
std::string encode_png(const CodedImage& image);
std::string encode_png(const Image& image, const glm::dvec3& background, ImageColorSpace space);

// Returns the codes that write_png() stores: red, green and blue, row 0 on top.
std::vector<std::uint8_t> png_codes(const Image& image, const glm::dvec3& background,
                                    ImageColorSpace space);

// Reads a PNG file's codes; palettes and grey of fewer than 8 bits are expanded to 8 bits, and a
// transparent colour becomes alpha. Throws Error for damaged files and sizes beyond image_limits.h.
CodedImage read_png(const std::filesystem::path& path);

}  // namespace lamina

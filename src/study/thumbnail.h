// SPDX-License-Identifier: Apache-2.0
// Pictures for a page.
#pragma once

#include <string>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"
#include "lamina/image_color_space.h"

namespace lamina::study {

// The picture as write_png shows it on black: 8-bit sRGB codes, three channels.
CodedImage shown(const Image& image, ImageColorSpace space = ImageColorSpace::linear);

// The divisor of the sides after which neither has more than `largest` pixels.
int reduction(int width, int height, int largest = 256);

// The means of squares of `step` x `step` pixels.
Image reduced(const Image& image, int step);
// The pixel with the largest |e| of each square, so that no error is averaged away.
Difference reduced(const Difference& difference, int step);

// An RGB picture of 8 bits as "data:image/png;base64,...".
std::string data_uri(const CodedImage& image);
// Bytes of that media type as "data:...;base64,...".
std::string data_uri(const std::string& type, const std::string& bytes);

}  // namespace lamina::study

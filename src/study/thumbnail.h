// SPDX-License-Identifier: Apache-2.0
// Small pictures inside a page.
#pragma once

#include <string>

#include "image/coded_image.h"
#include "image/difference.h"
#include "lamina/image.h"

namespace lamina::study {

// By what sides are divided so that none has more than `largest` pixels.
int reduction(int width, int height, int largest = 256);

// Means of squares of `step` x `step` pixels.
Image reduced(const Image& image, int step);
// Of each square the pixel with the largest |e|: no error is averaged away.
Difference reduced(const Difference& difference, int step);

// "data:image/png;base64,...", of an RGB picture of 8 bits.
std::string data_uri(const CodedImage& image);

}  // namespace lamina::study

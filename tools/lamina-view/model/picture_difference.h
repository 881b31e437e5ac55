// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/image.h"

namespace lamina::view {

// The signed difference of two pictures, in 1/255: of each pixel that of the channel in which it is
// largest. NaN: not known (not traced yet). Row by row from the top.
struct PictureDifference {
    int width = 0, height = 0;
    std::vector<float> e;
};

// a - b, of pictures of one size.
PictureDifference difference_of(const Image& a, const Image& b);
// Returns the signed difference of one pixel (red, green, blue and opacity) in the channel in which
// it is largest.
float largest_difference(const float* a, const float* b);

// Returns the largest |e|, rounded up to 1, 2 or 5 times a power of ten: a scale that the whole
// difference fits into. Pictures that are equal get the smallest one.
double fitting_range(const PictureDifference& difference);
inline constexpr double smallest_range = 1e-4;

}  // namespace lamina::view

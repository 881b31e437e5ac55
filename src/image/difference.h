// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "image/coded_image.h"
#include "lamina/image.h"

namespace lamina {

// The difference e = A - B in units of 1/255, pixel by pixel from the top left, channels
// interleaved.
struct Difference {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  // R, G, B, A; for PNGs also Y
    std::vector<double> e;
};

// Both throw Error where the sizes differ (the message has both), and for PNGs where the channels
// differ.
template <typename RealA, typename RealB>
Difference difference(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b);

// Compares stored codes. A 16-bit code counts 1/257 of an 8-bit code.
Difference difference(const CodedImage& a, const CodedImage& b);

extern template Difference difference(const Image&, const Image&);
extern template Difference difference(const Image&, const PreciseImage&);
extern template Difference difference(const PreciseImage&, const Image&);
extern template Difference difference(const PreciseImage&, const PreciseImage&);

}  // namespace lamina

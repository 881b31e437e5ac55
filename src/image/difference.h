// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "image/coded_image.h"
#include "lamina/image.h"

namespace lamina {

// The difference e = A - B in units of 1/255, row by row from the top, channels interleaved.
struct Difference {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;  // R, G, B, A; for PNGs also Y
    std::vector<double> e;
};

// Both throw Error, which has both sizes, if these differ; for PNGs also if the channels do.
template <typename RealA, typename RealB>
Difference difference(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b);

// Compares stored codes. A 16-bit code counts 1/257 of an 8-bit code.
Difference difference(const CodedImage& a, const CodedImage& b);

extern template Difference difference(const Image&, const Image&);
extern template Difference difference(const Image&, const PreciseImage&);
extern template Difference difference(const PreciseImage&, const Image&);
extern template Difference difference(const PreciseImage&, const PreciseImage&);

struct ImageError {
    struct Worst {
        int column = 0, row = 0;
        std::size_t channel = 0;  // index into `channels`
        double e = 0;
    };

    std::vector<std::string> channels;
    std::vector<ErrorNorms> of_channel;
    ErrorNorms all;
    Worst worst;  // the first component with |e| = all.linf
};

// Throws Error if the spaces differ.
void check_spaces(ImageColorSpace a, ImageColorSpace b);

// Throws Error if some e is not finite.
ImageError measure(const Difference& difference);

template <typename RealA, typename RealB>
ImageError image_error(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b) {
    return measure(difference(a, b));
}

// A picture of a difference in 8-bit sRGB codes: each pixel's largest |e|, blue where e < 0, white
// at 0 (for any scale), red where e > 0, darkest where |e| >= scale (in 1/255).
CodedImage false_color(const Difference& difference, double scale);

// Returns the colour, in sRGB codes, of e = share * scale, for -1 <= share <= 1.
std::array<std::uint16_t, 3> false_color_of(double share);

// Draws false_color() and below it the colour bar from -scale to scale with numbers at its ends,
// "<=" and ">=" if differences beyond are clipped. White fills up narrow pictures.
CodedImage difference_picture(const Difference& difference, double scale);

}  // namespace lamina

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

// Both functions throw Error if the sizes differ; for PNGs also if the channels do.
template <typename RealA, typename RealB>
Difference difference(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b);

// Compares stored codes. A step of a 16-bit code counts 1/257 of a step of an 8-bit code.
Difference difference(const CodedImage& a, const CodedImage& b);

extern template Difference difference(const Image&, const Image&);
extern template Difference difference(const Image&, const PreciseImage&);
extern template Difference difference(const PreciseImage&, const Image&);
extern template Difference difference(const PreciseImage&, const PreciseImage&);

// Norms of a difference, for each channel and for all channels together.
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

void check_spaces(ImageColorSpace a, ImageColorSpace b);  // throws Error if they differ

ImageError measure(const Difference& difference);  // throws Error if some e is not finite

template <typename RealA, typename RealB>
ImageError image_error(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b) {
    return measure(difference(a, b));
}

// Returns a picture of a difference in 8-bit sRGB codes. Each pixel shows its e of the largest |e|:
// blue if e < 0, white if e = 0 (for any scale), red if e > 0, darkest if |e| >= scale (in 1/255).
CodedImage false_color(const Difference& difference, double scale);

// Returns the colour, in sRGB codes, of e = share * scale, for -1 <= share <= 1.
std::array<std::uint16_t, 3> false_color_of(double share);

// Returns false_color() above a colour bar from -scale to scale, whose numbers begin with "<=" and
// ">=" if larger differences are clipped. Narrow pictures are filled up with white.
CodedImage difference_picture(const Difference& difference, double scale);

}  // namespace lamina

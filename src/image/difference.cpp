// SPDX-License-Identifier: Apache-2.0
#include "image/difference.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lamina {

namespace {

template <typename A, typename B>
Difference blank(const A& a, const B& b, std::vector<std::string> channels) {
    if (a.width != b.width || a.height != b.height) {
        fail("the images differ in size: {} x {} and {} x {}", a.width, a.height, b.width,
             b.height);
    }
    return {a.width, a.height, std::move(channels), {}};
}

std::vector<std::string> channel_names(int channels) {
    if (channels == 1) return {"Y"};
    if (channels == 2) return {"Y", "A"};
    if (channels == 3) return {"R", "G", "B"};
    return {"R", "G", "B", "A"};
}

}  // namespace

template <typename RealA, typename RealB>
Difference difference(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b) {
    Difference result = blank(a, b, channel_names(4));
    result.e.resize(a.rgba.size());
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        result.e[i] = 255 * (static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
    }
    return result;
}

Difference difference(const CodedImage& a, const CodedImage& b) {
    Difference result = blank(a, b, channel_names(a.channels));
    if (a.channels != b.channels) {
        fail("the images differ in channels: {} and {}", a.channels, b.channels);
    }
    // Both codes are brought to one denominator, so that equal codes differ by exactly 0 whatever
    // their depths.
    const int unit_a = a.bit_depth == 16 ? 1 : 257;
    const int unit_b = b.bit_depth == 16 ? 1 : 257;
    result.e.resize(a.codes.size());
    for (std::size_t i = 0; i < a.codes.size(); ++i) {
        result.e[i] = (a.codes[i] * unit_a - b.codes[i] * unit_b) / 257.0;
    }
    return result;
}

template Difference difference(const Image&, const Image&);
template Difference difference(const Image&, const PreciseImage&);
template Difference difference(const PreciseImage&, const Image&);
template Difference difference(const PreciseImage&, const PreciseImage&);

namespace {

struct Sums {
    double largest = 0;
    double sum = 0;
    double squares = 0;
    double count = 0;

    void add(const Sums& part) {
        largest = std::max(largest, part.largest);
        sum += part.sum;
        squares += part.squares;
        count += part.count;
    }
    ErrorNorms norms() const { return {largest, sum / count, std::sqrt(squares / count)}; }
};

}  // namespace

ImageError measure(const Difference& difference) {
    const std::size_t channels = difference.channels.size();
    const std::size_t row_numbers = static_cast<std::size_t>(difference.width) * channels;
    ImageError error;
    error.channels = difference.channels;
    std::vector<Sums> sums(channels);
    for (int row = 0; row < difference.height; ++row) {
        std::vector<Sums> of_row(
            channels);  // each row is summed by itself, which keeps rounding small
        const double* const e = &difference.e[static_cast<std::size_t>(row) * row_numbers];
        for (std::size_t i = 0; i < row_numbers; ++i) {
            const int column = static_cast<int>(i / channels);
            const std::size_t channel = i % channels;
            if (!std::isfinite(e[i] * e[i])) {
                fail("the difference at pixel ({}, {}), channel {}, is not finite", column, row,
                     difference.channels[channel]);
            }
            of_row[channel].add({std::abs(e[i]), e[i], e[i] * e[i], 1});
            if (std::abs(e[i]) > std::abs(error.worst.e)) {
                error.worst = {column, row, channel, e[i]};
            }
        }
        for (std::size_t c = 0; c < channels; ++c) sums[c].add(of_row[c]);
    }
    Sums all;
    for (const Sums& channel : sums) {
        error.of_channel.push_back(channel.norms());
        all.add(channel);
    }
    error.all = all.norms();
    return error;
}

ErrorNorms error_of(const Image& picture, const Image& truth) {
    return image_error(picture, truth).all;
}

ErrorNorms error_of(const Image& picture, const PreciseImage& truth) {
    return image_error(picture, truth).all;
}

}  // namespace lamina

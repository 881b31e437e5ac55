// SPDX-License-Identifier: Apache-2.0
#include "image/difference.h"

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

}  // namespace lamina

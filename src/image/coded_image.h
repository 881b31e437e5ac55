// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace lamina {

// Pixels in the form of an 8- or 16-bit PNG: sRGB codes that are not converted to linear light. Row
// 0 is the top; channels are interleaved.
struct CodedImage {
    int width = 0;
    int height = 0;
    int channels = 3;   // 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA (alpha not associated)
    int bit_depth = 8;  // 8: codes 0..255, 16: codes 0..65535
    std::vector<std::uint16_t> codes;

    CodedImage() = default;
    CodedImage(int width_pixels, int height_pixels, int channel_count, int depth)
        : width(width_pixels),
          height(height_pixels),
          channels(channel_count),
          bit_depth(depth),
          codes(static_cast<std::size_t>(width_pixels) * static_cast<std::size_t>(height_pixels) *
                static_cast<std::size_t>(channel_count)) {}
};

}  // namespace lamina

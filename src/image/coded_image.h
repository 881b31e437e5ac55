// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
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

using PixelColor = std::array<std::uint16_t, 3>;  // sRGB codes of 8 bits

// Height in dots of the letters of pictures' labels: ASCII in 5 x 7 dots, each `dot` x `dot`
// pixels, 6 dots apart. Other characters show as "?".
inline constexpr int text_dots_high = 7;
int text_width(std::string_view text, int dot);  // pixels

// Draws the text with its top left corner at (left, top). Parts outside the picture, which must
// have three channels of 8 bits, are cut off.
void draw_text(CodedImage& image, int left, int top, std::string_view text, int dot,
               const PixelColor& color);

// Fills the part of the rectangle that lies in the picture.
void fill_rectangle(CodedImage& image, int left, int top, int width, int height,
                    const PixelColor& color);

// Copies a picture, as far as it fits, into another one, its top left corner to (left, top).
void copy_into(CodedImage& image, const CodedImage& part, int left, int top);

}  // namespace lamina

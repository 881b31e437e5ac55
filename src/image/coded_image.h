// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lamina/image.h"

namespace lamina {

// Pixels of an 8- or 16-bit PNG: interleaved sRGB codes, row 0 on top.
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

// Height in dots of the letters of labels. Letters are ASCII in 5 x 7 dots, 6 dots apart; "?"
// stands for other characters. A dot is `dot` x `dot` pixels.
inline constexpr int text_dots_high = 7;
int text_width(std::string_view text, int dot);  // pixels

// Draws the text into an 8-bit RGB picture, its top left corner at (left, top).
void draw_text(CodedImage& image, int left, int top, std::string_view text, int dot,
               const PixelColor& color);

// Fills the part of the rectangle that lies in the picture.
void fill_rectangle(CodedImage& image, int left, int top, int width, int height,
                    const PixelColor& color);

// Copies `part`, as far as it fits, into `image`, its top left corner to (left, top).
void copy_into(CodedImage& image, const CodedImage& part, int left, int top);

// The transfer curve of sRGB (IEC 61966-2-1) from linear light to stored values, 0..1, and back.
double srgb_from_linear(double linear);
double linear_from_srgb(double stored);

// Returns the code of 8 or 16 bits that shows a number of a picture in `space`, clamped to 0..1.
std::uint16_t display_code(double value, ImageColorSpace space, int bits = 8);

}  // namespace lamina

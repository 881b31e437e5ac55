// SPDX-License-Identifier: Apache-2.0
#include "image/difference_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/false_color.h"
#include "image/pixel_text.h"

namespace lamina {
namespace {

constexpr int narrowest_bar = 160, wide = 400;  // pixels; from `wide` on letters are twice as large
constexpr int gap = 6, bar_high = 10;
constexpr PixelColor paper{255, 255, 255}, ink{40, 40, 40};

bool is_clipped(const Difference& difference, double scale) {
    return std::ranges::any_of(difference.e, [&](double e) { return std::abs(e) > scale; });
}

}  // namespace

CodedImage difference_picture(const Difference& difference, double scale) {
    const CodedImage colors = false_color(difference, scale);
    const int width = std::max(colors.width, narrowest_bar);
    const int dot = width >= wide ? 2 : 1;
    const int bar = colors.height + gap, text = bar + bar_high + gap / 2;
    CodedImage picture(width, text + text_dots_high * dot + gap, 3, 8);
    fill_rectangle(picture, 0, 0, picture.width, picture.height, paper);
    copy_into(picture, colors, 0, 0);
    for (int column = 0; column < width; ++column) {
        const double share = (2.0 * column + 1) / width - 1;
        fill_rectangle(picture, column, bar, 1, bar_high, false_color_of(share));
    }
    const bool clipped = is_clipped(difference, scale);
    const std::string left = fmt::format("{}-{:.3g}", clipped ? "<=" : "", scale);
    const std::string right = fmt::format("{}{:.3g}/255", clipped ? ">=" : "", scale);
    draw_text(picture, 0, text, left, dot, ink);
    draw_text(picture, (width - text_width("0", dot)) / 2, text, "0", dot, ink);
    draw_text(picture, width - text_width(right, dot), text, right, dot, ink);
    return picture;
}

}  // namespace lamina

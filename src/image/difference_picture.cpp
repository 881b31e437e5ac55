// SPDX-License-Identifier: Apache-2.0
#include "image/difference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include "image/coded_image.h"

namespace lamina {

namespace {

using Rgb = std::array<int, 3>;

// The diverging scheme RdBu of ColorBrewer (Brewer, Harrower), which stays legible with every
// common colour-vision deficiency. Its middle is made pure white. The colours run from 0 outwards
// at equal steps.
constexpr std::array<Rgb, 6> blues = {{{255, 255, 255},
                                       {209, 229, 240},
                                       {146, 197, 222},
                                       {67, 147, 195},
                                       {33, 102, 172},
                                       {5, 48, 97}}};
constexpr std::array<Rgb, 6> reds = {{{255, 255, 255},
                                      {253, 219, 199},
                                      {244, 165, 130},
                                      {214, 96, 77},
                                      {178, 24, 43},
                                      {103, 0, 31}}};

}  // namespace

std::array<std::uint16_t, 3> false_color_of(double share) {
    const std::array<Rgb, 6>& steps = share < 0 ? blues : reds;
    const double position = 5 * std::abs(share);
    const std::size_t lower = std::min<std::size_t>(static_cast<std::size_t>(position), 4);
    const double between = position - static_cast<double>(lower);
    std::array<std::uint16_t, 3> mixed{};
    for (std::size_t i = 0; i < 3; ++i) {
        mixed[i] = static_cast<std::uint16_t>(
            std::lround((1 - between) * steps[lower][i] + between * steps[lower + 1][i]));
    }
    return mixed;
}

CodedImage false_color(const Difference& difference, double scale) {
    CodedImage picture(difference.width, difference.height, 3, 8);
    const auto channels = static_cast<std::ptrdiff_t>(difference.channels.size());
    auto code = picture.codes.begin();
    for (auto e = difference.e.begin(); e != difference.e.end(); e += channels) {
        const double largest = *std::max_element(
            e, e + channels, [](double a, double b) { return std::abs(a) < std::abs(b); });
        const double share = largest == 0 ? 0 : std::clamp(largest / scale, -1.0, 1.0);
        for (const std::uint16_t component : false_color_of(share)) *code++ = component;
    }
    return picture;
}

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

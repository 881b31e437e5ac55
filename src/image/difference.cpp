// SPDX-License-Identifier: Apache-2.0
#include "image/difference.h"

#include <fmt/format.h>
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

struct Sums {
    double largest = 0;  // max of |e|
    double sum = 0;      // of e
    double squares = 0;  // sum of e^2
    double count = 0;    // number of values e

    void add(const Sums& part) {
        largest = std::max(largest, part.largest);
        sum += part.sum;
        squares += part.squares;
        count += part.count;
    }
    ErrorNorms norms() const { return {largest, sum / count, std::sqrt(squares / count)}; }
};

using Rgb = std::array<int, 3>;

// Colours for shares 0, .2, ..., 1 of the scale: ColorBrewer's diverging RdBu (Brewer, Harrower),
// legible with common colour-vision deficiencies. Its middle is white instead of grey.
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

// Sizes in pixels. In pictures that are at least `wide` wide, letters are twice as large.
constexpr int narrowest_bar = 160, wide = 400;
constexpr int gap = 6, bar_high = 10;
constexpr PixelColor paper{255, 255, 255}, ink{40, 40, 40};

bool is_clipped(const Difference& difference, double scale) {
    return std::ranges::any_of(difference.e, [&](double e) { return std::abs(e) > scale; });
}

}  // namespace

template <typename RealA, typename RealB>
Difference difference(const RgbaImage<RealA>& a, const RgbaImage<RealB>& b) {
    Difference result = blank(a, b, channel_names(4));
    result.e.resize(a.rgba.size());
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        result.e[i] = 255 * (static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
    return result;
}

Difference difference(const CodedImage& a, const CodedImage& b) {
    Difference result = blank(a, b, channel_names(a.channels));
    if (a.channels != b.channels)
        fail("the images differ in channels: {} and {}", a.channels, b.channels);
    // Differences are in units of 1/65535, so that equal colours of different depths differ by 0.
    const int unit_a = a.bit_depth == 16 ? 1 : 257;
    const int unit_b = b.bit_depth == 16 ? 1 : 257;
    result.e.resize(a.codes.size());
    for (std::size_t i = 0; i < a.codes.size(); ++i)
        result.e[i] = (a.codes[i] * unit_a - b.codes[i] * unit_b) / 257.0;
    return result;
}

template Difference difference(const Image&, const Image&);
template Difference difference(const Image&, const PreciseImage&);
template Difference difference(const PreciseImage&, const Image&);
template Difference difference(const PreciseImage&, const PreciseImage&);

ImageError measure(const Difference& difference) {
    const std::size_t channels = difference.channels.size();
    const std::size_t row_numbers = static_cast<std::size_t>(difference.width) * channels;
    ImageError error;
    error.channels = difference.channels;
    std::vector<Sums> sums(channels);
    for (int row = 0; row < difference.height; ++row) {
        std::vector<Sums> of_row(
            channels);  // rows are summed separately, which keeps rounding small
        const double* const e = &difference.e[static_cast<std::size_t>(row) * row_numbers];
        for (std::size_t i = 0; i < row_numbers; ++i) {
            const int column = static_cast<int>(i / channels);
            const std::size_t channel = i % channels;
            if (!std::isfinite(e[i] * e[i])) {
                fail("the difference at pixel ({}, {}), channel {}, is not finite", column, row,
                     difference.channels[channel]);
            }
            of_row[channel].add({std::abs(e[i]), e[i], e[i] * e[i], 1});
            if (std::abs(e[i]) > std::abs(error.worst.e))
                error.worst = {column, row, channel, e[i]};
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

void check_spaces(ImageColorSpace a, ImageColorSpace b) {
    if (a != b) fail("the images differ in colour space: {} and {}", name_of(a), name_of(b));
}

ErrorNorms error_of(const Image& picture, const Image& truth) {
    check_spaces(picture.space, truth.space);
    return image_error(picture, truth).all;
}

ErrorNorms error_of(const Image& picture, const PreciseImage& truth) {
    check_spaces(picture.space, truth.space);
    return image_error(picture, truth).all;
}

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

// SPDX-License-Identifier: Apache-2.0
#include "study/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "image/png.h"
#include "image/srgb.h"

namespace lamina::study {
namespace {

std::string base64(const std::string& bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j)
            group =
                group << 8 | (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[group >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

// Calls visit(column, row) for the pixels of a square that are inside.
template <typename Visit>
void for_each_in_square(int column, int row, int step, int width, int height, const Visit& visit) {
    for (int y = row * step; y < std::min((row + 1) * step, height); ++y) {
        for (int x = column * step; x < std::min((column + 1) * step, width); ++x) visit(x, y);
    }
}

int squares(int pixels, int step) {
    return (pixels + step - 1) / step;
}

}  // namespace

CodedImage shown(const Image& image, ImageColorSpace space) {
    CodedImage coded(image.width, image.height, 3, 8);
    for (std::size_t i = 0; i < coded.codes.size(); ++i)
        coded.codes[i] = display_code(static_cast<double>(image.rgba[i / 3 * 4 + i % 3]), space);
    return coded;
}

int reduction(int width, int height, int largest) {
    return squares(std::max(width, height), largest);
}

Image reduced(const Image& image, int step) {
    Image small(squares(image.width, step), squares(image.height, step));
    for (int row = 0; row < small.height; ++row) {
        for (int column = 0; column < small.width; ++column) {
            double sum[4] = {}, count = 0;
            for_each_in_square(column, row, step, image.width, image.height, [&](int x, int y) {
                for (int i = 0; i < 4; ++i) sum[i] += static_cast<double>(image.pixel(x, y)[i]);
                ++count;
            });
            for (int i = 0; i < 4; ++i)
                small.pixel(column, row)[i] = static_cast<float>(sum[i] / count);
        }
    }
    return small;
}

Difference reduced(const Difference& difference, int step) {
    const std::size_t channels = difference.channels.size();
    Difference small{
        squares(difference.width, step), squares(difference.height, step), difference.channels, {}};
    for (int row = 0; row < small.height; ++row) {
        for (int column = 0; column < small.width; ++column) {
            const double* worst = nullptr;
            double largest = -1;
            for_each_in_square(
                column, row, step, difference.width, difference.height, [&](int x, int y) {
                    const auto pixel =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(difference.width) +
                        static_cast<std::size_t>(x);
                    const double* const e = &difference.e[channels * pixel];
                    for (std::size_t i = 0; i < channels; ++i) {
                        if (std::abs(e[i]) <= largest) continue;
                        largest = std::abs(e[i]);
                        worst = e;
                    }
                });
            small.e.insert(small.e.end(), worst, worst + channels);
        }
    }
    return small;
}

std::string data_uri(const CodedImage& image) {
    return data_uri("image/png", encode_png(image));
}

std::string data_uri(const std::string& type, const std::string& bytes) {
    return "data:" + type + ";base64," + base64(bytes);
}

}  // namespace lamina::study

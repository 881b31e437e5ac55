// SPDX-License-Identifier: Apache-2.0
#include "parallel/fragment_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random_picture.h"

namespace lamina {
namespace {

constexpr int width = 300, height = 40;
constexpr RowSpan rows{5, 33};

// Returns the picture as another rank receives it: encoded, decoded, and composited behind nothing.
Image sent(const Image& picture, FragmentFormat format, std::size_t* size = nullptr) {
    std::vector<std::byte> bytes;
    encode_rows(picture, ActiveRuns(picture, {0, height}), rows, format, bytes);
    if (size != nullptr) *size = bytes.size();
    Image result(width, height);
    put_rows_behind(bytes, rows, format, result);
    return result;
}

double largest_error(const Image& picture, FragmentFormat format, bool opacity) {
    const Image arrived = sent(picture, format);
    double largest = 0;
    for (int row = rows.first; row < rows.end; ++row) {
        for (int i = 0; i < 4 * width; ++i) {
            if ((i % 4 == 3) != opacity) continue;
            largest = std::max(largest, std::abs(double{arrived.pixel(0, row)[i]} -
                                                 double{picture.pixel(0, row)[i]}));
        }
    }
    return 255 * largest;
}

TEST(FragmentCode, KeepsFloatsExactly) {
    const Image picture = random_picture(width, height, 1, 5);
    EXPECT_EQ(largest_error(picture, FragmentFormat::float32, false), 0);
    EXPECT_EQ(largest_error(picture, FragmentFormat::float32, true), 0);
}

// Half has 11 bits: half a step in [.5, 1] is 2^-12.
TEST(FragmentCode, RoundsHalvesByAtMostHalfAStep) {
    const Image picture = random_picture(width, height, 2);
    EXPECT_LE(largest_error(picture, FragmentFormat::half, false), 255 * 0x1p-12);
    EXPECT_LE(largest_error(picture, FragmentFormat::half, true), 255 * 0x1p-12);
}

// Errors are half a code and a few roundings of float32.
TEST(FragmentCode, RoundsCodesByAtMostHalfACode) {
    constexpr double code16 = 255 * .5 / 65535, roundings = 255 * 4 * 6e-8;
    const Image picture = random_picture(width, height, 3);
    for (const bool opacity : {false, true})
        EXPECT_LE(largest_error(picture, FragmentFormat::fixed16, opacity), code16 + roundings);
    // The colour is an 8-bit code times the 16-bit code of opacity.
    EXPECT_LE(largest_error(picture, FragmentFormat::fixed8, false), .5 + code16 + roundings);
    EXPECT_LE(largest_error(picture, FragmentFormat::fixed8, true), code16 + roundings);
}

TEST(FragmentCode, ScalesColorsAboveOneToCodes) {
    constexpr float largest = 20;
    const Image picture = random_picture(width, height, 4, largest);
    const double error = largest_error(picture, FragmentFormat::fixed8, false);
    EXPECT_LE(error, largest * (.5 + .003));
    EXPECT_GT(error, 1);
}

// A picture takes the bytes of its pixels, and at most 3 for each run (its length or the gap before
// it is below 128 pixels) and 1 for each row.
TEST(FragmentCode, SendsOnlyWhatShows) {
    const Image picture = random_picture(width, height, 5);
    const ActiveRuns runs(picture, rows);
    std::size_t pixels = 0, numbers = sizeof(float);
    for (int row = rows.first; row < rows.end; ++row) {
        pixels += static_cast<std::size_t>(runs.pixels(row));
        numbers += 3 * static_cast<std::size_t>(runs.end(row) - runs.begin(row)) + 1;
    }
    for (const auto& [format, size] : {std::pair{FragmentFormat::float32, 16u},
                                       {FragmentFormat::half, 8u},
                                       {FragmentFormat::fixed16, 8u},
                                       {FragmentFormat::fixed8, 5u}}) {
        std::size_t bytes = 0;
        sent(picture, format, &bytes);
        EXPECT_GE(bytes, size * pixels);
        EXPECT_LE(bytes, size * pixels + numbers);
    }
}

TEST(FragmentCode, IsCompositedBehindThePicture) {
    const Image front = random_picture(width, height, 6), back = random_picture(width, height, 7);
    std::vector<std::byte> bytes;
    encode_rows(back, ActiveRuns(back, rows), rows, FragmentFormat::float32, bytes);
    Image arrived = front, local = front;
    put_rows_behind(bytes, rows, FragmentFormat::float32, arrived);
    put_rows_behind(back, ActiveRuns(back, rows), rows, local);
    EXPECT_EQ(arrived.rgba, local.rgba);
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const float* const one = front.pixel(column, row);
            const float* const other = back.pixel(column, row);
            const bool sent_row = row >= rows.first && row < rows.end;
            for (int channel = 0; channel < 4; ++channel) {
                const float over =
                    sent_row ? one[channel] + (1 - one[3]) * other[channel] : one[channel];
                EXPECT_EQ(local.pixel(column, row)[channel], over);
            }
        }
    }
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "image/difference.h"

#include <gtest/gtest.h>

#include <array>

namespace lamina {
namespace {

using Rgb = std::array<std::uint16_t, 3>;

Rgb pixel(const CodedImage& image, int column, int row) {
    const auto at = static_cast<std::size_t>(3 * (row * image.width + column));
    return {image.codes[at], image.codes[at + 1], image.codes[at + 2]};
}

// Returns the number of dark dots in these columns, from `first_row` down: those of the text below
// the bar.
int ink(const CodedImage& image, int first_row, int first, int end) {
    int dots = 0;
    for (int row = first_row; row < image.height; ++row)
        for (int column = first; column < end; ++column)
            dots += pixel(image, column, row) == Rgb{40, 40, 40};
    return dots;
}

TEST(DifferencePicture, HasTheColorsAboveAndTheirBarBelow) {
    const Difference difference{3, 2, {"Y"}, {-4, -2, 0, 2, 4, 8}};
    const CodedImage whole = difference_picture(difference, 8);
    ASSERT_EQ(whole.width, 160);
    const CodedImage colors = false_color(difference, 8);
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_EQ(pixel(whole, column, row), pixel(colors, column, row));
    EXPECT_EQ(pixel(whole, 3, 0), (Rgb{255, 255, 255}));
    // The bar begins 6 pixels below the picture. Each of its columns shows the difference at the
    // middle of the column.
    for (const int column : {0, 17, 80, 159})
        EXPECT_EQ(pixel(whole, column, 2 + 6 + 4), false_color_of((2 * column + 1) / 160.0 - 1));
    const int text = 2 + 6 + 10 + 3;
    EXPECT_GT(ink(whole, text, 0, 20), 0);
    EXPECT_GT(ink(whole, text, 75, 85), 0);
    EXPECT_GT(ink(whole, text, 130, 160), 0);
    // The text of a clipped end begins with "<=", which has 7 + 10 dots; the rest of the text is
    // the same.
    const CodedImage clipped = difference_picture(difference, 7.99999);
    EXPECT_EQ(ink(clipped, text, 0, 40) - ink(whole, text, 0, 40), 7 + 10);
}

TEST(DifferencePicture, WidePicturesKeepTheirWidth) {
    const Difference difference{500, 1, {"Y"}, std::vector<double>(500)};
    const CodedImage picture = difference_picture(difference, 0);
    EXPECT_EQ(picture.width, 500);
    EXPECT_EQ(pixel(picture, 499, 0), (Rgb{255, 255, 255}));
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "image/difference.h"

#include <gtest/gtest.h>

#include "image/coded_image.h"

namespace lamina {
namespace {

using Codes = std::vector<std::uint16_t>;

Codes color_of(double e, double scale) {
    return false_color({1, 1, {"Y"}, {e}}, scale).codes;
}

double luminance(const Codes& rgb) {
    return 0.2126 * linear_from_srgb(rgb[0] / 255.0) + 0.7152 * linear_from_srgb(rgb[1] / 255.0) +
           0.0722 * linear_from_srgb(rgb[2] / 255.0);
}

TEST(FalseColor, IsWhiteAtZeroAndSaturatedAtTheScale) {
    EXPECT_EQ(color_of(0, 2), (Codes{255, 255, 255}));
    EXPECT_EQ(color_of(0, 0), (Codes{255, 255, 255}));
    EXPECT_EQ(color_of(2, 2), (Codes{103, 0, 31}));
    EXPECT_EQ(color_of(-2, 2), (Codes{5, 48, 97}));
    EXPECT_EQ(color_of(50, 2), color_of(2, 2));
    EXPECT_EQ(color_of(-50, 2), color_of(-2, 2));
}

TEST(FalseColor, ShowsSizeAsDarknessAndSignAsHue) {
    double lighter[2] = {2, 2};
    for (int i = 1; i <= 100; ++i) {
        for (const int side : {0, 1}) {
            const Codes rgb = color_of(side == 0 ? -i : i, 100);
            EXPECT_LT(luminance(rgb), lighter[side]) << i;
            lighter[side] = luminance(rgb);
            // People who cannot distinguish red from green still distinguish yellow from blue:
            // yellow minus blue must have the sign of e.
            const int yellow = (rgb[0] + rgb[1]) / 2 - rgb[2];
            if (i >= 3) {
                EXPECT_GT(side == 0 ? -yellow : yellow, 0) << i;
            }
        }
    }
}

TEST(FalseColor, ShowsTheChannelWithTheLargestError) {
    const Difference difference{2, 1, {"R", "G", "B"}, {1, -3, 2, 0, 0, 1}};
    const CodedImage picture = false_color(difference, 4);
    ASSERT_EQ(picture.codes.size(), 6u);
    EXPECT_EQ(Codes(picture.codes.begin(), picture.codes.begin() + 3), color_of(-3, 4));
    EXPECT_EQ(Codes(picture.codes.begin() + 3, picture.codes.end()), color_of(1, 4));
}

}  // namespace
}  // namespace lamina

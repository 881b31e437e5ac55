// SPDX-License-Identifier: Apache-2.0
#include "image/coded_image.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace lamina {
namespace {

// Draws a text and returns its dots as lines of '#' and '.'. Dots of `dot` x `dot` pixels are read
// at their first pixel.
std::string dots_of(const std::string& text, int dot = 1) {
    CodedImage image(text_width(text, dot), text_dots_high * dot, 3, 8);
    draw_text(image, 0, 0, text, dot, {9, 9, 9});
    std::string dots;
    for (int row = 0; row < image.height; row += dot) {
        for (int column = 0; column < image.width; column += dot) {
            const auto at = static_cast<std::size_t>(3 * (row * image.width + column));
            dots += image.codes[at] == 9 ? '#' : '.';
        }
        dots += '\n';
    }
    return dots;
}

TEST(PixelText, DrawsLettersOfFiveBySevenDots) {
    EXPECT_EQ(dots_of("1T"),
              "..#..."
              "#####\n"
              ".##..."
              "..#..\n"
              "..#..."
              "..#..\n"
              "..#..."
              "..#..\n"
              "..#..."
              "..#..\n"
              "..#..."
              "..#..\n"
              ".###.."
              "..#..\n");
    EXPECT_EQ(dots_of("x=-12.5e3", 3), dots_of("x=-12.5e3"));
}

TEST(PixelText, EveryCharacterHasItsOwnShape) {
    std::set<std::string> shapes;
    for (char character = ' '; character <= '~'; ++character)
        shapes.insert(dots_of(std::string(1, character)));
    EXPECT_EQ(shapes.size(), 95u);
    EXPECT_EQ(dots_of("\xc3"), dots_of("?"));
}

TEST(PixelText, StaysInsideThePicture) {
    CodedImage image(4, 4, 3, 8);
    draw_text(image, -3, -3, "###", 2, {1, 1, 1});
    draw_text(image, 100, 100, "###", 2, {1, 1, 1});
    fill_rectangle(image, -5, -5, 100, 100, {7, 8, 9});
    for (std::size_t i = 0; i < image.codes.size(); ++i) EXPECT_EQ(image.codes[i], 7 + i % 3);
    CodedImage small(2, 3, 3, 8);
    copy_into(image, small, 3, 2);
    EXPECT_EQ(image.codes[3 * (2 * 4 + 3)], 0);
    EXPECT_EQ(image.codes[3 * (2 * 4 + 2)], 7);
}

}  // namespace
}  // namespace lamina

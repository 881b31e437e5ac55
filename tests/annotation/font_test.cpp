// SPDX-License-Identifier: Apache-2.0
#include "annotation/font.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/expect_error.h"

namespace lamina {
namespace {

using Characters = std::vector<char32_t>;

TEST(Font, DecodesUtf8) {
    EXPECT_EQ(characters_of("a\u00b5\u20ac\U0001F600"), (Characters{'a', 0xB5, 0x20AC, 0x1F600}));
    EXPECT_EQ(characters_of(""), Characters{});
    EXPECT_EQ(characters_of("\x7f"), Characters{0x7F});
    EXPECT_EQ(characters_of("\xf4\x8f\xbf\xbf"), Characters{0x10FFFF});
}

// By Unicode 15, table 3-7: the well-formed byte sequences.
TEST(Font, RejectsWhatIsNoUtf8) {
    for (const char* const bad :
         {"\x80", "\xc0\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
          "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xe2(\xa1", "\xff", "a\xb5"}) {
        EXPECT_EQ(characters_of(bad), std::nullopt) << bad;
    }
    expect_error([] { check_text("image.annotations.title.text", "ab\xff"); },
                 {"image.annotations.title.text", "byte 2", "0xff", "UTF-8"});
    EXPECT_NO_THROW(check_text("x", "Größe"));
}

TEST(Font, RefusesTextsThatNoPictureHolds) {
    EXPECT_NO_THROW(check_text("x", std::string(longest_text, 'a')));
    expect_error([] { check_text("image.annotations.title.text", std::string(10'001, 'a')); },
                 {"image.annotations.title.text", "10001 bytes", "at most 10000"});
}

// Advances of DejaVu Sans 2.37 in its table hmtx, of 2048 to the em: A 1401, figures 1303.
TEST(Font, IsDejaVuSans) {
    Font font;
    EXPECT_DOUBLE_EQ(font.width("A", 2048), 1401);
    EXPECT_DOUBLE_EQ(font.width("0123456789", 204.8), 1303);
    EXPECT_DOUBLE_EQ(font.width("", 10), 0);
}

TEST(Font, CapitalsStandOnTheBaseLineAndHaveTheirHeight) {
    Font font;
    double low = -INFINITY, high = INFINITY;
    const Outline outlines = font.outlines("H", {5, 40}, 30);
    for (const auto& contour : outlines.contours()) {
        for (const glm::dvec2& point : contour) {
            low = std::max(low, point.y);
            high = std::min(high, point.y);
        }
    }
    EXPECT_DOUBLE_EQ(low, 40);
    EXPECT_NEAR(low - high, Font::capital_height(30), 30.0 / 2048);
}

TEST(Font, CountersOfLettersAreEmpty) {
    Font font;
    Canvas canvas(100, 100, ImageColorSpace::linear);
    canvas.fill(font.outlines("O", {10, 90}, 100), {glm::dvec3(1)});
    const auto layer = canvas.take();
    // The middle of an O of width 1612 / 2048 em and of the height of a capital.
    const int column = 10 + 1612 * 50 / 2048, row = 90 - 36;
    EXPECT_EQ(layer->pixel(column, row)[3], 0);
    EXPECT_EQ(layer->pixel(17, row)[3], 1);  // the stem
}

// The longest beginning that leaves room for the ellipsis, found by trial.
TEST(Font, ShortensTextsToTheirRoom) {
    Font font;
    const std::string text = "Großhirnrinde";
    const std::vector<std::string> beginnings = {
        "",        "G",        "Gr",        "Gro",        "Groß",        "Großh",        "Großhi",
        "Großhir", "Großhirn", "Großhirnr", "Großhirnri", "Großhirnrin", "Großhirnrind", text};
    for (double most = 0; most < 90; most += 0.5) {
        std::string expected = "\u2026";
        for (const std::string& beginning : beginnings)
            if (font.width(beginning + "\u2026", 10) <= most) expected = beginning + "\u2026";
        if (font.width(text, 10) <= most) expected = text;
        EXPECT_EQ(font.fitted(text, 10, most), expected) << most;
    }
    EXPECT_EQ(font.fitted("", 10, 0), "");
}

TEST(Font, ReadsTextsOnlyAsFarAsTheirRoomGoes) {
    Font font;
    EXPECT_LT(font.fitted(std::string(64'000'000, 'a') + "\u6f22", 10, 100).size(), 30u);
    EXPECT_TRUE(font.missing().empty());
    // Combining characters take no room.
    std::string accents;
    while (accents.size() < 1'000'000) accents += "\u0301";
    ASSERT_EQ(font.width("\u0301", 10), 0);
    const std::string fitted = font.fitted(accents, 10, 100);
    EXPECT_LE(fitted.size(), longest_text + 3);
    EXPECT_TRUE(characters_of(fitted));
}

TEST(Font, TellsWhatItLacks) {
    Font font;
    font.width("Temperature in \u00b0C, \u03bcm, \u2212\u2026", 10);
    EXPECT_TRUE(font.missing().empty());
    font.width("\u6f22\u5b57\u6f22", 10);
    EXPECT_EQ(font.missing(), (Characters{0x6F22, 0x5B57}));
}

TEST(Font, ShowsBytesThatAreNoTextAsReplacements) {
    Font font;
    EXPECT_DOUBLE_EQ(font.width("a\xff", 10), font.width("a\uFFFD", 10));
}

}  // namespace
}  // namespace lamina

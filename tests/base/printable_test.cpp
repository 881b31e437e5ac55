// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

namespace lamina {
namespace {

TEST(Printable, TextOfAnyLanguageIsUnchanged) {
    for (const char* const text :
         {"", "plain text, 1..2 'quoted' C:\\x", "M\xC3\xBCnchen", "\xE2\x82\xAC",
          "\xF0\x9F\x8C\x8D", "\xC2\xA0", "\xED\x9F\xBF", "\xEE\x80\x80", "\xF4\x8F\xBF\xBF"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, ControlCharactersAreNamed) {
    EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\x0dd");
    EXPECT_EQ(printable("\x1b[31mred"), "\\x1b[31mred");
    EXPECT_EQ(printable(std::string("\0\x1f\x7f", 3)), "\\x00\\x1f\\x7f");
    EXPECT_EQ(printable("\xC2\x80 \xC2\x9B"
                        "31m"),
              // U+0080, and U+009B, which begins escape sequences of ISO 6429.
              "\\xc2\\x80 \\xc2\\x9b31m");
}

// One case for each kind of ill-formed sequence in the Unicode Standard.
TEST(Printable, BytesThatAreNotUtf8AreNamed) {
    EXPECT_EQ(printable("a\xFFz"), "a\\xffz");
    EXPECT_EQ(printable("\x80"), "\\x80");
    EXPECT_EQ(printable("\xC3"), "\\xc3");
    EXPECT_EQ(printable("\xC3("), "\\xc3(");
    EXPECT_EQ(printable("\xC1\x81"), "\\xc1\\x81");
    EXPECT_EQ(printable("\xE0\x9F\xBF"), "\\xe0\\x9f\\xbf");
    EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");
    EXPECT_EQ(printable("\xF0\x8F\xBF\xBF"), "\\xf0\\x8f\\xbf\\xbf");
    EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
    EXPECT_EQ(printable("\xE2\x82"), "\\xe2\\x82");
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

namespace lamina {
namespace {

TEST(OneLine, ControlCharactersBecomeSingleSpaces) {
    EXPECT_EQ(one_line("plain text"), "plain text");
    EXPECT_EQ(one_line("two\nlines"), "two lines");
    EXPECT_EQ(one_line("  \r\n a \t\x01 b  \n"), "a b");
    EXPECT_EQ(one_line("\n\n"), "");
    EXPECT_EQ(one_line("M\xC3\xBCnchen.exr"), "M\xC3\xBCnchen.exr");  // UTF-8 stays
}

TEST(Fail, FormatsItsMessage) {
    try {
        fail("{}: found {}, expected {}", "scene.json", 3, "2");
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "scene.json: found 3, expected 2");
    }
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

// Expects none of the words by which messages of libraries are recognised.
void expect_no_library_speaks(const std::string& text) {
    for (const char* const mark : {"json", "std::", "filesystem error", "vector", "basic_string"})
        EXPECT_EQ(text.find(mark), std::string::npos) << text;
}

TEST(ErrorText, KeepsTheWordsOfErrorsThatUsersCause) {
    EXPECT_EQ(error_text(Error("a.json: found 3")), "a.json: found 3");
    EXPECT_EQ(error_text(UsageError("--x: found 3")), "--x: found 3");
    EXPECT_EQ(error_text(std::bad_alloc()), "out of memory");
}

TEST(ErrorText, NamesTheFileThatTheSystemRefuses) {
    const std::string longest(5000, 'a');
    try {
        (void)std::filesystem::exists(std::filesystem::path("/tmp") / longest);
        FAIL();
    } catch (const std::exception& error) {
        const std::string text = error_text(error);
        EXPECT_TRUE(text.starts_with("/tmp/aaaa")) << text;
        EXPECT_TRUE(text.ends_with("...: File name too long")) << text;
        EXPECT_LT(text.size(), 200u);
        expect_no_library_speaks(text);
    }
}

TEST(ErrorText, CallsAnythingElseAMistakeOfLamina) {
    const auto expect_mistake = [](const std::function<void()>& work) {
        try {
            work();
            FAIL();
        } catch (const std::exception& error) {
            const std::string text = error_text(error);
            EXPECT_TRUE(text.starts_with("a mistake of lamina")) << text;
            EXPECT_NE(text.find("please report"), std::string::npos) << text;
            expect_no_library_speaks(text);
        }
    };
    expect_mistake([] { (void)nlohmann::json().value("files", 0); });
    expect_mistake([] { (void)nlohmann::json("\xff").dump(); });
    expect_mistake([] { (void)std::vector<int>().at(0); });
    expect_mistake([] { (void)std::stoi("x"); });
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "base/standard_streams.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/warning.h"

namespace lamina {
namespace {

TEST(StandardStreams, MessagesAreOneLineWithoutControlCharacters) {
    ::testing::internal::CaptureStderr();
    print_message("lamina: wrote {}\n", "a\x1b[2J\nb\xff.exr");
    replace_line("a\nb");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "lamina: wrote a\\x1b[2J\\nb\\xff.exr\n\r\033[Ka\\nb");
}

TEST(Warning, GoesToWhoTakesIt) {
    warn("nobody hears");
    std::vector<std::string> heard;
    take_warnings([&](const std::string& text) { heard.push_back(text); });
    warn("one");
    take_warnings({});
    warn("nobody hears");
    EXPECT_EQ(heard, std::vector<std::string>{"one"});
}

}  // namespace
}  // namespace lamina

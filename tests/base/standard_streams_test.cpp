// SPDX-License-Identifier: Apache-2.0
#include "base/process.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/client.h"
#include "support/heard_warnings.h"

namespace lamina {
namespace {

TEST(StandardStreams, MessagesAreOneLineWithoutControlCharacters) {
    ::testing::internal::CaptureStderr();
    print_message("lamina: wrote {}\n", "a\x1b[2J\nb\xff.exr");
    replace_line("a\nb");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "lamina: wrote a\\x1b[2J\\nb\\xff.exr\n\r\033[Ka\\nb");
}

TEST(Warning, GoesToTheListenerOfTheScope) {
    warn("nobody hears");
    {
        const test::HeardWarnings heard;
        warn("one");
        EXPECT_EQ(heard.texts, std::vector<std::string>{"one"});
    }
    warn("nobody hears");
}

}  // namespace
}  // namespace lamina

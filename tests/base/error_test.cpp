// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
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

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Prints error_text() of what oneTBB throws if a thread would get a stack of 1 GiB and the process
// may take 256 MiB of addresses.
[[noreturn]] void start_a_thread_without_memory() {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
    const tbb::global_control stack(tbb::global_control::thread_stack_size, std::size_t{1} << 30);
    const rlimit limit{rlim_t{1} << 28, rlim_t{1} << 28};
    setrlimit(RLIMIT_AS, &limit);
    try {
        tbb::task_arena(4).execute([] { tbb::parallel_for(0, 1'000'000, [](int) {}); });
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error_text(error).c_str());
    }
    std::_Exit(0);
}

// The test runs in a process of its own, in which oneTBB has no threads yet.
TEST(ErrorTextDeathTest, SaysThatTheSystemRefusesAThread) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(start_a_thread_without_memory(), testing::ExitedWithCode(0),
                "^the system refuses a thread: [^:]+\n$");
}
#endif

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
    expect_mistake([] { throw std::runtime_error("pthread_join has failed: No such process"); });
}

}  // namespace
}  // namespace lamina

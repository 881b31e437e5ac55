// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <vector>

#include "base/error.h"

namespace lamina {
namespace {

TEST(ParallelFor, CallsEveryIndexOnce) {
    for (const std::int64_t count : {0, 1, 7, 10000}) {
        std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
        parallel_for(count, 16, [&](std::int64_t i) { ++calls[static_cast<std::size_t>(i)]; });
        for (const std::atomic<int>& n : calls) EXPECT_EQ(n, 1);
    }
}

TEST(ParallelFor, RethrowsWhatACallThrows) {
    std::string message;
    try {
        parallel_for(1000, 1, [](std::int64_t i) {
            if (i == 617) fail("number {}", i);
        });
    } catch (const Error& error) {
        message = error.what();
    }
    EXPECT_EQ(message, "number 617");
}

// In a process of its own, because an interrupt stays set.
TEST(ParallelForDeathTest, StopsWhenInterrupted) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    const auto interrupted_loop = [] {
        std::signal(SIGINT, SIG_DFL);  // a shell's background ignores it
        catch_interrupts();
        std::atomic<int> calls = 0;
        try {
            parallel_for(1000000, 1, [&](std::int64_t) {
                if (++calls == 10) std::raise(SIGINT);
            });
        } catch (const Interrupted&) {
            std::exit(calls < 1000000 ? 130 : 1);
        }
        std::exit(2);
    };
    EXPECT_EXIT(interrupted_loop(), testing::ExitedWithCode(130), "");
}

}  // namespace
}  // namespace lamina

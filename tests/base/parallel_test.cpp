// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/process.h"

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

// A death test, because the signal goes to the process: it needs a process of its own.
TEST(ParallelForDeathTest, StopsWhenInterrupted) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    const auto code_of_interrupted_loop = [] {
        std::signal(SIGINT, SIG_DFL);  // shells let background processes ignore it
        const SignalStop signals;
        const ClientScope scope({.stop = signals.token()});
        std::atomic<int> calls = 0;
        try {
            parallel_for(1000000, 1, [&](std::int64_t) {
                if (++calls != 10) return;
                std::raise(SIGINT);
                while (!signals.token().stop_requested()) std::this_thread::yield();
            });
        } catch (const Interrupted&) {
            return calls < 1000000 ? signals.exit_code() : 1;
        }
        return 2;
    };
    EXPECT_EXIT(std::exit(code_of_interrupted_loop()), testing::ExitedWithCode(130), "");
}

}  // namespace
}  // namespace lamina

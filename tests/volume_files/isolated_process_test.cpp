// SPDX-License-Identifier: Apache-2.0
#include "volume_files/isolated_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"

namespace lamina {
namespace {

// Tells if a process runs: it exists and is no zombie, a record that its parent has not collected.
bool is_running(pid_t process) {
    std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
    std::string number, name, state;
    return static_cast<bool>(stream >> number >> name >> state) && state != "Z";
}

// The work waits for ever, as opening a pipe may do, and the starter of its process is killed.
TEST(IsolatedProcess, EndsWhenItsStarterIsKilled) {
    int line[2] = {-1, -1};
    ASSERT_EQ(pipe(line), 0);
    const pid_t starter = fork();
    if (starter == 0) {
        const IsolatedProcess isolated("name", "library", [&](IsolatedLine&) {
            const pid_t own = getpid();
            if (write(line[1], &own, sizeof own) != sizeof own) _exit(1);
            while (true) pause();
        });
        while (true) pause();
    }
    pid_t isolated = -1;
    ASSERT_EQ(read(line[0], &isolated, sizeof isolated), static_cast<ssize_t>(sizeof isolated));
    EXPECT_TRUE(is_running(isolated));
    kill(starter, SIGKILL);
    waitpid(starter, nullptr, 0);
    // The isolated process looks every second if its starter still runs.
    for (int tenths = 0; tenths < 200 && is_running(isolated); ++tenths)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_FALSE(is_running(isolated));
    for (const int end : line) close(end);
}

TEST(IsolatedProcess, CutsLongTextsOffAndGoesOn) {
    const test::HeardWarnings heard;
    IsolatedProcess process("name", "library", [](IsolatedLine& line) {
        warn(std::string(1 << 17, 'w'));
        line.answer("answer", 6);
        fail("{}", std::string(1 << 17, 'e'));
    });
    std::string answer(6, ' ');
    process.receive(answer.data(), answer.size());
    EXPECT_EQ(answer, "answer");
    ASSERT_EQ(heard.texts.size(), 1u);
    EXPECT_EQ(heard.texts[0], std::string(1 << 16, 'w'));
    expect_error([&] { process.receive(answer.data(), answer.size()); },
                 {std::string(1 << 16, 'e')});
}

// 9 items of 4 MiB take several processes if there are cores for them.
TEST(IsolatedBytes, FillEachItemOnceInItsPlace) {
    constexpr std::size_t items = 9, each = std::size_t{4} << 20;
    const auto filled = isolated_bytes("name", "library", items * each, items * each, each, items,
                                       [&](std::size_t first, std::size_t end, char* to) {
                                           for (std::size_t i = first; i < end; ++i)
                                               for (std::size_t j = 0; j < each; ++j)
                                                   to[i * each + j] += static_cast<char>(i + 1);
                                       });
    const auto* const bytes = static_cast<const char*>(filled.get());
    for (std::size_t i = 0; i < items * each; ++i)
        ASSERT_EQ(bytes[i], static_cast<char>(i / each + 1)) << i;
}

// Sets the least file number that may not be opened, for this process and those it starts.
void allow_files(rlim_t count) {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = count;
    setrlimit(RLIMIT_NOFILE, &limit);
}

// A process takes two files of its starter for as long as it runs, and three while it starts.
TEST(IsolatedBytes, AreFilledByTheProcessesThatCanBeStarted) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "sanitizers open pipes of their own to look at pointers";
#endif
    constexpr std::size_t items = 9, each = std::size_t{4} << 20;
    rlimit before{};
    getrlimit(RLIMIT_NOFILE, &before);
    allow_files(64);
    std::vector<int> taken;
    for (int file = 0; (file = dup(STDERR_FILENO)) >= 0;) taken.push_back(file);
    ASSERT_GE(taken.size(), 4u);
    for (int i = 0; i < 4; ++i) {
        close(taken.back());
        taken.pop_back();
    }
    std::shared_ptr<void> filled;
    std::string error;
    try {
        filled = isolated_bytes("name", "library", items * each, items * each, each, items,
                                [](std::size_t first, std::size_t end, char* to) {
                                    for (std::size_t i = first; i < end; ++i)
                                        to[i * each] = static_cast<char>(end - first);
                                });
    } catch (const Error& refusal) {
        error = refusal.what();
    }
    for (const int file : taken) close(file);
    allow_files(before.rlim_cur);
    ASSERT_EQ(error, "");
    for (std::size_t i = 0; i < items; ++i)
        EXPECT_EQ(static_cast<const char*>(filled.get())[i * each], static_cast<char>(items));
}

// Each of 2 to 16 processes is allowed what its own part takes, and one item more.
TEST(IsolatedBytes, BoundEachProcessByItsOwnPart) {
    constexpr std::size_t items = 16, each = std::size_t{32} << 20;
    struct Limits {
        std::size_t items, memory, seconds;  // above those that the process has at its start
    };
    const auto filled = isolated_bytes(
        "name", "library", items * sizeof(Limits), items * each, each, items,
        [](std::size_t first, std::size_t end, char* to) {
            rlimit memory{}, time{};
            getrlimit(RLIMIT_AS, &memory);
            getrlimit(RLIMIT_CPU, &time);
            std::size_t pages = 0;
            std::ifstream("/proc/self/statm") >> pages;
            const std::size_t there = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
            const bool is_limited = memory.rlim_cur != RLIM_INFINITY;  // not with sanitizers
            const Limits limits{end - first, is_limited ? memory.rlim_cur - there : 0,
                                time.rlim_cur};
            for (std::size_t i = first; i < end; ++i)
                std::memcpy(to + i * sizeof limits, &limits, sizeof limits);
        });
    std::array<Limits, items> limits{};
    std::memcpy(limits.data(), filled.get(), sizeof limits);
    for (const Limits& one : limits) {
        // Decoded bytes take 4 bytes each beside 256 MiB, and a second a MiB beside 5 s. A process
        // has used less than one second before.
        EXPECT_LE(one.memory, (std::size_t{256} << 20) + 4 * (one.items + 1) * each);
        EXPECT_LE(one.seconds, 5 + ((one.items + 1) * each >> 20) + 1);
        EXPECT_GE(one.seconds, 5 + (one.items * each >> 20));
    }
}

// The first part's error counts, whichever comes first.
TEST(IsolatedBytes, PassOnTheErrorOfOnePart) {
    constexpr std::size_t items = 9, each = std::size_t{4} << 20;
    expect_error(
        [] {
            isolated_bytes("name", "library", items * each, items * each, each, items,
                           [](std::size_t, std::size_t end, char*) {
                               if (end == items) fail("name: item {}", end - 1);
                           });
        },
        {"name: item 8"});
}

}  // namespace
}  // namespace lamina

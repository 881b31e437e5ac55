// SPDX-License-Identifier: Apache-2.0
#include "volume_files/isolated_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

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
    const auto filled = isolated_bytes("name", "library", items * each, items * each, items,
                                       [&](std::size_t first, std::size_t end, char* to) {
                                           for (std::size_t i = first; i < end; ++i)
                                               for (std::size_t j = 0; j < each; ++j)
                                                   to[i * each + j] += static_cast<char>(i + 1);
                                       });
    const auto* const bytes = static_cast<const char*>(filled.get());
    for (std::size_t i = 0; i < items * each; ++i)
        ASSERT_EQ(bytes[i], static_cast<char>(i / each + 1)) << i;
}

// The first part's error counts, whichever comes first.
TEST(IsolatedBytes, PassOnTheErrorOfOnePart) {
    constexpr std::size_t items = 9, each = std::size_t{4} << 20;
    expect_error(
        [] {
            isolated_bytes("name", "library", items * each, items * each, items,
                           [](std::size_t, std::size_t end, char*) {
                               if (end == items) fail("name: item {}", end - 1);
                           });
        },
        {"name: item 8"});
}

}  // namespace
}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#include "base/client.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// Reports progress of work that lasts longer than the half second between two drawings.
void work() {
    Progress progress("slicing", 4);
    progress.advance();
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    progress.advance();
}

// Sends stderr to `descriptor` while `action` runs.
template <typename Action>
void with_stderr(int descriptor, const Action& action) {
    const int saved = dup(STDERR_FILENO);
    dup2(descriptor, STDERR_FILENO);
    action();
    dup2(saved, STDERR_FILENO);
    close(saved);
}

// Tells whether pseudo terminals can be made: a bare chroot has none.
bool has_terminals() {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0) return false;
    grantpt(terminal);
    unlockpt(terminal);
    const int device = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    if (device >= 0) close(device);
    close(terminal);
    return device >= 0;
}

// Returns what arrives at a terminal during work(), and a dot that marks marks the end.
std::string seen_on_terminal() {
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    grantpt(terminal);
    unlockpt(terminal);
    const int device = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    with_stderr(device, [] {
        work();
        (void)!write(STDERR_FILENO, ".", 1);  // the end
    });
    // The kernel may deliver the text in any number of pieces.
    std::string seen;
    char piece[1000];
    for (ssize_t count = 1; count > 0 && !seen.ends_with('.');) {
        count = read(terminal, piece, sizeof piece);
        seen.append(piece, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    close(device);
    close(terminal);
    return seen;
}

TEST(Progress, IsSilentWhereThereIsNoTerminal) {
    const TemporaryFolder folder;
    const int file = open((folder / "stderr").c_str(), O_WRONLY | O_CREAT, 0600);
    with_stderr(file, work);
    close(file);
    EXPECT_EQ(read_bytes_of(folder / "stderr"), "");
}

TEST(Progress, DrawsOnATerminalAndWipesItsLine) {
    if (!has_terminals()) GTEST_SKIP() << "no pseudo terminals";
    const std::string seen = seen_on_terminal();
    EXPECT_NE(seen.find("slicing  50 %"), std::string::npos) << seen;
    EXPECT_TRUE(seen.ends_with("\r\033[K.")) << seen;
}

TEST(Progress, IsSilentWhenQuiet) {
    if (!has_terminals()) GTEST_SKIP() << "no pseudo terminals";
    Progress::set_quiet(true);
    EXPECT_EQ(seen_on_terminal(), ".");
    Progress::set_quiet(false);
}

// Work shorter than the pause between two reports reports at least its end. It is repeated so often
// that two cores sometimes reach the end together.
TEST(Progress, ReportsItsEndHoweverShortTheWork) {
    for (int i = 0; i < 5000; ++i) {
        std::vector<double> shares;
        ProgressListener listener;
        listener.report = [&](const std::string&, double share) { shares.push_back(share); };
        Client client;
        client.progress = &listener;
        const ClientScope scope(client);
        {
            Progress progress("tracing", 64);
            parallel_for(64, 1, [&](std::int64_t) { progress.advance(); });
        }
        ASSERT_FALSE(shares.empty()) << i;
        ASSERT_EQ(shares.back(), 1) << i;
        ASSERT_TRUE(std::is_sorted(shares.begin(), shares.end())) << i;
    }
}

}  // namespace
}  // namespace lamina

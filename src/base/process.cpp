// SPDX-License-Identifier: Apache-2.0
#include "base/process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "base/error.h"

namespace lamina {

namespace {

void write_to_stderr(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

// Semaphore by which a signal handler wakes SignalStop's thread: global, as a handler gets only the
// signal; never destroyed, as one may still run when a SignalStop ends.
struct Wake {
    Wake() { sem_init(&semaphore, 0, 0); }
    sem_t semaphore{};
} wake;

std::atomic<int> caught = 0;  // the signal; 0: none
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");
std::atomic<bool> exists = false;

// The handler. POSIX allows sem_post() in signal handlers.
void on_signal(int signal) {
    const int error_of_interrupted_code = errno;
    caught = signal;
    sem_post(&wake.semaphore);
    errno = error_of_interrupted_code;
}

bool is_program(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

// Returns the folder of programs installed with the library, for other programs that load it.
std::filesystem::path programs_of_library() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&is_program), &info) == 0 || !info.dli_fname)
        return {};
    return std::filesystem::path(info.dli_fname).parent_path() / LAMINA_PROGRAMS_FROM_LIBRARY;
}

}  // namespace

void make_streams_safe() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
        // Opened so that reading from stdin, and writing to stdout and stderr, fails. open()
        // returns the lowest free descriptor, which is this one.
        open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

void write_result(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        fail("cannot write to stdout: {}", std::strerror(errno));
}

void flush_results() {
    const bool broken = std::ferror(stdout) != 0;
    if (std::fflush(stdout) != 0) fail("cannot write to stdout: {}", std::strerror(errno));
    if (broken) fail("cannot write to stdout: not all of it could be written");
}

void write_message(const std::string& line) {
    const std::size_t end = line.ends_with('\n') ? line.size() - 1 : line.size();
    write_to_stderr(printable(line.substr(0, end)) + line.substr(end));
}

void replace_line(const std::string& line) {
    write_to_stderr("\r\033[K" + printable(line));
}

SignalStop::SignalStop() {
    [[maybe_unused]] const bool existed = exists.exchange(true);
    assert(!existed);
    caught = 0;
    waiter_ = std::jthread([this](const std::stop_token& ending) {
        while (caught == 0 && !ending.stop_requested()) sem_wait(&wake.semaphore);
        if (caught != 0) source_.request_stop();
    });
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < signals.size(); ++i) {
        sigaction(signals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) sigaction(signals[i], &action, nullptr);
    }
}

SignalStop::~SignalStop() {
    for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
    waiter_.request_stop();
    sem_post(&wake.semaphore);
    waiter_.join();
    exists = false;
}

int SignalStop::exit_code() const {
    return 128 + caught;
}

std::optional<std::filesystem::path> find_program(const std::string& name) {
    std::error_code failure;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
    for (const auto& folder : {self.parent_path(), programs_of_library()}) {
        if (!folder.empty() && is_program(folder / name)) return folder / name;
    }
    const char* const folders = std::getenv("PATH");
    std::istringstream list(folders ? folders : "");
    for (std::string folder; std::getline(list, folder, ':');) {
        // Empty entries mean the current folder, whose programs must not be started.
        if (folder.empty()) continue;
        if (is_program(std::filesystem::path(folder) / name))
            return std::filesystem::path(folder) / name;
    }
    return std::nullopt;
}

}  // namespace lamina

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

#include <array>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace lamina {

// Must be called before any file is opened. Afterwards a write into a pipe without a reader, or
// beyond the limit on the size of files, fails but does not end the process. Standard descriptors
// that were closed are occupied, so that no file that is opened later becomes stdout.
void make_streams_safe();

// Writes a result to stdout. Throws Error if it cannot be written (a full disk, no reader).
void write_result(const std::string& text);
void flush_results();  // writes out what is buffered; throws Error

// Writes a message, escaped by printable() except its newline, to stderr, or loses it.
void write_message(const std::string& line);
// Writes a message that replaces the terminal's current line and does not end it.
void replace_line(const std::string& line);

template <typename... Args>
void print_result(fmt::format_string<Args...> format, Args&&... args) {
    write_result(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void print_message(fmt::format_string<Args...> format, Args&&... args) {
    write_message(fmt::format(format, std::forward<Args>(args)...));
}

// While it exists, SIGINT, SIGTERM and SIGHUP request a stop through its token, unless they were
// ignored before (nohup). A program makes one, only one at a time, and works within a ClientScope
// with its token. Throws std::system_error if its thread cannot be started.
class SignalStop {
  public:
    SignalStop();
    ~SignalStop();
    SignalStop(const SignalStop&) = delete;
    SignalStop& operator=(const SignalStop&) = delete;

    std::stop_token token() const { return source_.get_token(); }

    // Returns 128 plus the signal's number (130 for Ctrl-C). Valid once a stop is requested.
    int exit_code() const;

  private:
    static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

    std::stop_source source_;
    // This thread calls stop_source::request_stop(), which takes a lock: a signal handler must not.
    std::jthread waiter_;
    std::array<struct sigaction, signals.size()> before_{};
};

// Finds a program beside the running one, among those installed with the library, or in the PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace lamina

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

// Must be called at the start, before any file is opened. Afterwards writing into a pipe without a
// reader, or beyond the limit on the size of files, is an error of the write and does not end the
// process. Standard descriptors that the caller has closed are occupied; otherwise the first file
// that is opened would become stdout and receive the results. Using such a descriptor still fails.
void make_streams_safe();

// Writes a result to stdout. Throws Error if it cannot be written (a full disk, no reader).
void write_result(const std::string& text);
void flush_results();  // writes out what is buffered; throws Error

// Writes a message for people to stderr: one line with its newline, the only control character that
// is not escaped as by printable(). If it cannot be written, it is lost without an error.
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

// Makes SIGINT, SIGTERM and SIGHUP request a stop of its token while it exists; they do not end the
// process. Signals that were set to be ignored before (nohup, a shell's background) stay ignored.
// Programs make one and work within a ClientScope with its token. Only one may exist at a time.
// Throws std::system_error if its thread cannot be started.
class SignalStop {
  public:
    SignalStop();
    ~SignalStop();
    SignalStop(const SignalStop&) = delete;
    SignalStop& operator=(const SignalStop&) = delete;

    std::stop_token token() const { return source_.get_token(); }

    // Returns 128 plus the signal's number, as shells have it: 130 for Ctrl-C. Valid once a stop is
    // requested.
    int exit_code() const;

  private:
    static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

    std::stop_source source_;
    // This thread calls stop_source::request_stop(), which takes a lock: a signal handler must not.
    std::jthread waiter_;
    std::array<struct sigaction, signals.size()> before_{};
};

// Finds a program that was built or installed with this one: beside the running program, among the
// programs installed with the library, or else in the PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace lamina

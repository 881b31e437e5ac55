// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace lamina {

// Must be called at the start, before any file is opened. Afterwards writing into a pipe without a
// reader, or beyond the limit on the size of files, is an error of the write and does not end the
// process. It also occupies standard descriptors that the caller closed. Otherwise the first file
// that is opened would become stdout and receive the results. Using such a descriptor still fails.
void make_streams_safe();

// Writes a result to stdout. Throws Error where it cannot be written (a full disk, no reader).
void write_result(const std::string& text);
void flush_results();  // writes out what is buffered; throws Error

// Writes a message for people to stderr: one line with its newline, which is the only control
// character that is not escaped as by printable(). Where it cannot be written, it is lost without
// an error.
void write_message(const std::string& line);
// The same, but it replaces the terminal's current line and does not end it.
void replace_line(const std::string& line);

template <typename... Args>
void print_result(fmt::format_string<Args...> format, Args&&... args) {
    write_result(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void print_message(fmt::format_string<Args...> format, Args&&... args) {
    write_message(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lamina

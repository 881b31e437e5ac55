// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace lamina {

// At the start, before any file is opened. Writing into a pipe that nobody reads, or beyond the
// limit on the size of files, becomes an error of the write instead of the process's end. And
// descriptors that the caller closed are taken, or the first file opened would become stdout and
// get the results: whatever uses them still fails.
void make_streams_safe();

// A result, to stdout. Throws Error when it does not arrive (a full disk, nobody who reads).
void write_result(const std::string& text);
void flush_results();  // of what still waits in memory; throws Error

// For people, to stderr: one line with its end, which alone is not shown as printable() does. What
// does not arrive is lost: no reason to fail.
void write_message(const std::string& line);
// The same, in place of the line in which a terminal's cursor is and without ending it.
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

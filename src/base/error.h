// SPDX-License-Identifier: Apache-2.0
#pragma once

// The errors that a user can cause: Error (exit code 1), UsageError (2), and Interrupted by a
// signal (128 plus its number). Mistakes of the program itself are assert()s.
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include "lamina/error.h"

namespace lamina {

// The command line is not valid: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

// Returns a text on one line: newlines and other control characters become single spaces.
std::string one_line(const std::string& text);

// Returns the message of an exception, for people: one line in lamina's own words. Errors that a
// user can cause have their message. A refusal of the file system is named with the system's
// reason. Any other exception is a mistake of the program, and the line says what to report.
std::string error_text(const std::exception& error);

}  // namespace lamina

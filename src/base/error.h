// SPDX-License-Identifier: Apache-2.0
// The errors that a user can cause: Error (exit code 1), UsageError (2), and Interrupted by a
// signal (128 plus its number). Mistakes of the program itself are assert()s.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

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

// `text` on one line: newlines and other control characters become single spaces.
std::string one_line(const std::string& text);

}  // namespace lamina

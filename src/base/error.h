// SPDX-License-Identifier: Apache-2.0
// The errors that a user can cause. Mistakes of the program itself are assert()s.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace lamina {

// Bad data, or a machine that cannot do what was asked: exit code 1. The message is one line that
// names the file, the field or line, what was found and what was expected.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// A command line that makes no sense: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// The user pressed Ctrl-C: exit code 130. The message says what is left behind.
class Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted, nothing written") {}
    using std::runtime_error::runtime_error;
};

template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

// `text` on one line: newlines and other control characters become single spaces.
std::string one_line(const std::string& text);

}  // namespace lamina

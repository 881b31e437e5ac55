// SPDX-License-Identifier: Apache-2.0
// Errors that a user can cause: Error (exit code 1), UsageError (2) and, by a signal, Interrupted
// (128 + its number); mistakes of the program are assert()s. Also texts for messages.
#pragma once

#include <fmt/format.h>
#include <cstddef>
#include <exception>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
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

// Returns a text on one line: newlines and other control characters become single spaces.
std::string one_line(const std::string& text);

// Returns an exception's message on one line. User errors have their own; file-system errors get
// the system's reason; any other is a mistake of the program, and the line says what to report.
std::string error_text(const std::exception& error);

// Returns a text for a message, cut between two characters if it has more than `most` bytes.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
    if (text.size() <= most) return text;
    const auto continues = [&](std::size_t at) {
        // Continuation bytes of UTF-8 are 10xxxxxx.
        return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
    };
    std::size_t end = most - 3;
    while (end > most - 6 && continues(end)) --end;
    return text.substr(0, end) + "...";
}

// Returns a text without control characters, which a terminal would obey: these (also those of two
// bytes), and bytes that are not UTF-8, become \n, \t or \xNN.
std::string printable(std::string_view text);

// Returns a number with `digits` significant digits, or as many more as bring it within `fineness`
// of the value, so that close numbers far from zero can be told apart.
std::string number_text(double value, double fineness, int digits = 4);

// Returns a fineness that keeps values in lo .. hi distinct: a thousandth of the range, > 0.
double fineness_of(double lo, double hi);

// Returns a share as a percentage with three digits.
std::string percent_text(double share);

// Returns the end of a message about an unknown word: ", did you mean "..."?" if a known one is
// near, else ", expected one of ...". Empty if no words are known.
std::string suggestion(const std::set<std::string>& words, const std::string& word);

}  // namespace lamina

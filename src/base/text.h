// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace lamina {

// Returns a text for a message, cut between two characters if it has more than `most` bytes.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
    if (text.size() <= most) return text;
    const auto continues = [&](std::size_t at) {
        // A continuation byte of UTF-8.
        return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
    };
    std::size_t end = most - 3;
    while (end > most - 6 && continues(end)) --end;
    return text.substr(0, end) + "...";
}

// Returns a text that a terminal shows without obeying it. Control characters (also those of two
// bytes, which some terminals obey) and bytes that are not UTF-8 become \n, \t or \xNN. Names of
// files, and names inside files, may contain any bytes.
std::string printable(std::string_view text);

// Returns a number for people, with `digits` significant digits, or with as many more as bring it
// within `fineness` of the value. So numbers that lie close together far from zero can be told
// apart.
std::string number_text(double value, double fineness, int digits = 4);

// Returns a fineness that tells values between lo and hi apart: a thousandth of the range, always
// above 0.
double fineness_of(double lo, double hi);

// Returns a share as a percentage with three digits.
std::string percent_text(double share);

// Returns the end of a message about an unknown word: ", did you mean "..."?" if a known word is
// near, else ", expected one of ...". Empty if no words are known.
std::string suggestion(const std::set<std::string>& words, const std::string& word);

}  // namespace lamina

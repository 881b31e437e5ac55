// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace lamina {

// `text` for a message: where it has more than `most` bytes, it is cut between two characters.
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

// `text` in a form that a terminal shows without executing it. Control characters (also those of
// two bytes, which some terminals obey) and bytes that are not UTF-8 become \n, \t or \xNN. Names
// of files and names inside files may contain any bytes.
std::string printable(std::string_view text);

// A number for people: with `digits` significant digits, or with so many more that it is within
// `fineness` of the value. So numbers that lie close together far from zero can be told apart.
std::string number_text(double value, double fineness, int digits = 4);

// The fineness that tells values of a range from lo to hi apart: a thousandth of it, and more than
// 0.
double fineness_of(double lo, double hi);

// A share as a percentage with three digits.
std::string percent_text(double share);

// The end of a message about a word that is none of the known ones: ", did you mean "..."?" where
// one of them is near, else ", expected one of ...". Empty where there are none.
std::string suggestion(const std::set<std::string>& words, const std::string& word);

}  // namespace lamina

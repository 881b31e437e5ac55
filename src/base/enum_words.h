// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

namespace lamina {

// The words of an enum class as files and messages have them, with their values, in the order in
// which the enum lists these. name_of(Enum) is their only table: a switch with a case for every
// value, so that the compiler names it where a new one lacks its word, and nullptr behind it, where
// the words end. The enum's values must be 0, 1, 2, ...
template <typename Enum>
std::vector<std::pair<const char*, Enum>> enum_words() {
    std::vector<std::pair<const char*, Enum>> words;
    for (int number = 0;; ++number) {
        const auto value = static_cast<Enum>(number);
        const char* const word = name_of(value);
        if (word == nullptr) return words;
        words.emplace_back(word, value);
    }
}

}  // namespace lamina

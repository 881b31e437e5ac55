// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

namespace lamina {

// The words of an enum class that files and messages use, with their values, in the order of the
// enum. name_of(Enum) is the only table of these words. It is a switch with a case for every value,
// so that the compiler warns where a new value lacks its word, followed by a return of nullptr,
// which marks the end of the words. The enum's values must be 0, 1, 2, ...
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

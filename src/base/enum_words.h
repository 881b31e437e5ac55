// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
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

// None where the word is none of the enum's.
template <typename Enum>
std::optional<Enum> value_of_word(std::string_view word) {
    for (const auto& [known, value] : enum_words<Enum>()) {
        if (word == known) return value;
    }
    return std::nullopt;
}

// "a, b or c", for messages.
template <typename Enum>
std::string alternatives() {
    const auto words = enum_words<Enum>();
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
        text += words[i].first;
    }
    return text;
}

}  // namespace lamina

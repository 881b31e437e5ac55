// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamina {

// Tells whether an enum has an enumerator of this value: compilers print others as (Enum)number.
template <auto value>
constexpr bool is_enumerator() {
    return std::string_view(__PRETTY_FUNCTION__).find("value = (") == std::string_view::npos;
}

// Returns the word of an enum's value (0, 1, 2, ...), or null beyond the last. `words` has one word
// for each enumerator, in their order. enum_words() takes an enum's words from its name_of().
template <typename Enum, std::size_t count>
const char* word_of(Enum value, const char* const (&words)[count]) {
    static_assert(is_enumerator<static_cast<Enum>(count - 1)>(), "a word without a value");
    static_assert(!is_enumerator<static_cast<Enum>(count)>(), "a value without its word");
    const auto number = static_cast<std::size_t>(value);
    return number < count ? words[number] : nullptr;
}

// Lists an enum's words, which its name_of() returns, and values in the enum's order.
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

// Returns the value of a word, or nothing if the enum has no such word.
template <typename Enum>
std::optional<Enum> value_of_word(std::string_view word) {
    for (const auto& [known, value] : enum_words<Enum>()) {
        if (word == known) return value;
    }
    return std::nullopt;
}

// Returns the words of an enum as "a, b or c", for messages.
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

// Marks the end of a `switch` over an enum class that returns in a case for every value. Such a
// switch has no `default:`, so that the compiler (-Wswitch) warns of a value without a case.
[[noreturn]] inline void unreachable_enum() {
    assert(false);
    __builtin_unreachable();
}

}  // namespace lamina

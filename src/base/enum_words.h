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

// Tells whether an enum class names this value: compilers write others as (Enum)number.
template <auto value>
constexpr bool is_enumerator() {
    return std::string_view(__PRETTY_FUNCTION__).find("value = (") == std::string_view::npos;
}

// Returns the value's word from the only table of an enum's words, which stands in its name_of(),
// in the order of the enum; null behind the last one. The enum's values must be 0, 1, 2, ...
template <typename Enum, std::size_t count>
const char* word_of(Enum value, const char* const (&words)[count]) {
    static_assert(is_enumerator<static_cast<Enum>(count - 1)>(), "a word without a value");
    static_assert(!is_enumerator<static_cast<Enum>(count)>(), "a value without its word");
    const auto number = static_cast<std::size_t>(value);
    return number < count ? words[number] : nullptr;
}

// Lists the words of an enum class that files and messages use, with their values, in the order of
// the enum. Its name_of() is made with word_of().
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

// Stands after a `switch` over an enum class that returns in a case for every value. Such a switch
// has no `default:`, so that the compiler (-Wswitch) warns where a new value lacks a case. But then
// the compiler assumes that other numbers may pass the switch, and warns that nothing is returned
// for these.
[[noreturn]] inline void unreachable_enum() {
    assert(false);
    __builtin_unreachable();
}

}  // namespace lamina

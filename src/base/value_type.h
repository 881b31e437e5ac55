// SPDX-License-Identifier: Apache-2.0
// The number types of arrays in data files.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lamina {

enum class ValueType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

// Calls `action` with a zero of the C++ type of `type`.
template <typename Action>
auto with_type(ValueType type, const Action& action) {
    switch (type) {
        case ValueType::int8:
            return action(std::int8_t{});
        case ValueType::uint8:
            return action(std::uint8_t{});
        case ValueType::int16:
            return action(std::int16_t{});
        case ValueType::uint16:
            return action(std::uint16_t{});
        case ValueType::int32:
            return action(std::int32_t{});
        case ValueType::uint32:
            return action(std::uint32_t{});
        case ValueType::int64:
            return action(std::int64_t{});
        case ValueType::uint64:
            return action(std::uint64_t{});
        case ValueType::float32:
            return action(float{});
        case ValueType::float64:
            break;
    }
    return action(double{});
}

constexpr ValueType value_types[] = {
    ValueType::int8,   ValueType::uint8, ValueType::int16,  ValueType::uint16,  ValueType::int32,
    ValueType::uint32, ValueType::int64, ValueType::uint64, ValueType::float32, ValueType::float64};
// The names of the types, in the order of value_types.
constexpr const char* value_type_words[] = {"int8",   "uint8", "int16",  "uint16", "int32",
                                            "uint32", "int64", "uint64", "float",  "double"};

inline const char* name_of(ValueType type) {
    return value_type_words[static_cast<std::size_t>(type)];
}

inline std::optional<ValueType> value_type_of(std::string_view word) {
    for (const ValueType type : value_types)
        if (word == name_of(type)) return type;
    return {};
}

inline std::string value_type_list() {
    std::string list;
    for (const char* const word : value_type_words)
        list += (list.empty() ? "" : ", ") + std::string(word);
    return list;
}

inline std::size_t bytes_of(ValueType type) {
    return with_type(type, [](auto zero) { return sizeof(zero); });
}

inline bool is_integer(ValueType type) {
    return type != ValueType::float32 && type != ValueType::float64;
}

// Converts a stored value to double or int64; uint64 above the largest int64 become that.
template <typename To, typename From>
To value_as(From value) {
    if constexpr (std::is_same_v<From, std::uint64_t> && std::is_same_v<To, std::int64_t>) {
        constexpr auto most = std::numeric_limits<std::int64_t>::max();
        return value > static_cast<std::uint64_t>(most) ? most : static_cast<To>(value);
    } else {
        return static_cast<To>(value);
    }
}

// Reads `count` values of `type` from unaligned `bytes`. `swap`: they have the other byte order.
template <typename To>
std::vector<To> values_from_bytes(ValueType type, const char* bytes, std::size_t count, bool swap) {
    return with_type(type, [&](auto zero) {
        using From = decltype(zero);
        std::vector<To> values(count);
        for (std::size_t i = 0; i < count; ++i) {
            char word[sizeof(From)];
            std::memcpy(word, bytes + i * sizeof(From), sizeof(From));
            if (swap) std::reverse(word, word + sizeof(From));
            From value;
            std::memcpy(&value, word, sizeof(From));
            values[i] = value_as<To>(value);
        }
        return values;
    });
}

}  // namespace lamina

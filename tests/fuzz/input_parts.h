// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace lamina::fuzz {

// Separates the two files of an input; it is a line of its own.
inline constexpr std::string_view part_mark = "\n=====\n";

// The two files of an input (runs.h says which).
struct InputParts {
    std::string_view first, second;  // `second` is empty if there is no mark
};

inline InputParts parts_of(std::string_view input) {
    const std::size_t mark = input.find(part_mark);
    if (mark == input.npos) return {input, {}};
    return {input.substr(0, mark + 1), input.substr(mark + part_mark.size())};
}

}  // namespace lamina::fuzz

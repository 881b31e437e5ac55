// SPDX-License-Identifier: Apache-2.0
#include "volume_files/file_pattern.h"

#include <fmt/format.h>

#include "volume_files/whole_number.h"

namespace lamina {

std::optional<FilePattern> file_pattern(std::string_view text) {
    const std::size_t percent = text.find('%');
    const std::size_t letter = text.find_first_not_of("0123456789", percent + 1);
    if (percent == text.npos || letter == text.npos || text[letter] != 'd') return {};
    FilePattern pattern{std::string(text.substr(0, percent)), std::string(text.substr(letter + 1)),
                        0};
    if (pattern.after.find('%') != std::string::npos) return {};
    if (letter > percent + 1) {
        const auto width = whole_number(text.substr(percent + 1, letter - percent - 1));
        if (!width || *width > 20) return {};
        pattern.width = static_cast<int>(*width);
    }
    return pattern;
}

std::optional<std::vector<std::string>> names_of(const FilePattern& pattern, std::int64_t first,
                                                 std::int64_t last, std::int64_t step) {
    constexpr std::int64_t largest = std::int64_t{1} << 40;
    const auto too_large = [](std::int64_t n) { return n > largest || n < -largest; };
    if (step == 0 || too_large(first) || too_large(last) || too_large(step)) return {};
    const std::int64_t count = (last - first) / step + 1;
    const bool leads_away = first != last && (first < last) != (step > 0);
    if (leads_away || count > most_pattern_files) return {};
    std::vector<std::string> names;
    for (std::int64_t i = 0; i < count; ++i) {
        names.push_back(fmt::format("{}{:0{}}{}", pattern.before, first + i * step, pattern.width,
                                    pattern.after));
    }
    return names;
}

}  // namespace lamina

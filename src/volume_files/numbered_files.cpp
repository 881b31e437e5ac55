// SPDX-License-Identifier: Apache-2.0
#include "volume_files/numbered_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <system_error>

namespace lamina {
namespace {

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

// Removes the digits, or the other characters, at the beginning of a name and returns them.
std::string_view take_run(std::string_view& name) {
    const bool digits = is_digit(name[0]);
    std::size_t count = 0;
    while (count < name.size() && is_digit(name[count]) == digits) ++count;
    const std::string_view run = name.substr(0, count);
    name.remove_prefix(count);
    return run;
}

std::string_view without_zeros(std::string_view digits) {
    return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

// Orders names by the numbers in them: a2 comes before a10.
bool comes_before(std::string_view a, std::string_view b) {
    const std::string_view whole_a = a, whole_b = b;
    while (!a.empty() && !b.empty()) {
        std::string_view run_a = take_run(a), run_b = take_run(b);
        if (is_digit(run_a[0]) && is_digit(run_b[0])) {
            run_a = without_zeros(run_a);
            run_b = without_zeros(run_b);
            if (run_a.size() != run_b.size()) return run_a.size() < run_b.size();
        }
        if (run_a != run_b) return run_a < run_b;
    }
    if (a.empty() != b.empty()) return a.empty();
    return whole_a < whole_b;  // names that differ in leading zeros alone
}

}  // namespace

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

std::string without_blanks(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

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

std::vector<std::filesystem::path> files_in_folder(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        std::error_code ignored;
        const auto& path = entry->path();
        if (path.filename().string()[0] != '.' && entry->is_regular_file(ignored))
            files.push_back(path);
    }
    std::ranges::sort(files, [](const auto& a, const auto& b) {
        return comes_before(a.filename().string(), b.filename().string());
    });
    return files;
}

}  // namespace lamina

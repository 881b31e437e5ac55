// SPDX-License-Identifier: Apache-2.0
#include "volume_files/numbered_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "image/picture.h"
#include "volume_files/stored_samples.h"

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

// The parts of a file's name: runs of digits, and what is between them with '#' for each run.
struct NameParts {
    explicit NameParts(std::string_view name) {
        while (!name.empty()) {
            const std::string_view run = take_run(name);
            text += is_digit(run[0]) ? "#" : run;
            if (is_digit(run[0])) numbers.emplace_back(without_zeros(run));
        }
    }
    std::string text;
    std::vector<std::string> numbers;  // without zeros in front
};

}  // namespace

std::string lower_case(std::string text) {
    for (char& letter : text)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return text;
}

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

std::vector<std::filesystem::path> known_files_in(const std::filesystem::path& path,
                                                  bool (*is_known)(const std::filesystem::path&)) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<std::filesystem::path> files = files_in_folder(path);
    std::erase_if(files, std::not_fn(is_known));
    return files;
}

std::string gaps_of(const std::vector<std::int64_t>& numbers) {
    std::int64_t step = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 1; i < numbers.size(); ++i)
        step = std::min(step, numbers[i] - numbers[i - 1]);
    std::string gaps;
    if (step < 1) return gaps;  // numbers that are too large for whole_number()
    for (std::size_t i = 1; i < numbers.size() && gaps.size() < 100; ++i) {
        const std::int64_t first = numbers[i - 1] + step, last = numbers[i] - step;
        if (first > last) continue;
        gaps += fmt::format("{}{}", gaps.empty() ? "" : ", ", first);
        if (last > first) gaps += fmt::format(" to {}", last);
    }
    return gaps;
}

void warn_of_series(const std::string& name, const char* kind,
                    const std::vector<std::filesystem::path>& files) {
    const std::size_t all = files_in_folder(name).size();  // 0 for a file
    if (all > files.size()) {
        say("{}: {} of {} files are no {}, and not used", name, all - files.size(), all, kind);
    }
    if (files.size() < 2) return;
    std::map<std::string, std::vector<NameParts>> series;
    for (const auto& file : files) {
        const NameParts parts(file.stem().string() + lower_suffix(file));  // .TIF as .tif
        series[parts.text].push_back(parts);
    }
    if (series.size() == files.size()) {
        say("{}: the names of its {} files do not differ in a number alone: they are "
            "taken in alphabetical order",
            name, files.size());
        return;
    }
    if (series.size() > 1) {
        const auto& [one, its] = *series.begin();
        const auto& [other, others] = *std::next(series.begin());
        fail(
            "{}: found {} series of files, such as {} of '{}' and {} of '{}', expected one: give "
            "each "
            "a folder of its own",
            name, series.size(), its.size(), one_line(one), others.size(), one_line(other));
    }
    const std::string text = one_line(series.begin()->first);
    const std::vector<NameParts>& parts = series.begin()->second;
    std::vector<std::size_t> changing;
    for (std::size_t i = 0; i < parts[0].numbers.size(); ++i) {
        if (std::ranges::any_of(parts, [&](const NameParts& each) {
                return each.numbers[i] != parts[0].numbers[i];
            }))
            changing.push_back(i);
    }
    if (changing.size() != 1) {
        fail(
            "{}: found {} numbers that change in the names '{}', expected one, of the slice: give "
            "each channel and time a folder of its own",
            name, changing.size(), text);
    }
    std::vector<std::int64_t> numbers;
    for (const NameParts& each : parts)
        numbers.push_back(whole_number("0" + each.numbers[changing[0]]).value_or(0));
    const std::string gaps = gaps_of(numbers);
    if (!gaps.empty()) {
        say("{}: in the series '{}' the numbers {} are missing: the slices beside a gap "
            "are neighbours here",
            name, text, gaps);
    }
}

}  // namespace lamina

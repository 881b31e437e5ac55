// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamina {

// Returns the number that all of a word is; nothing if it is none of this type.
template <typename Number>
std::optional<Number> number_in(std::string_view word) {
    Number number{};
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc{} || stop != end) return {};
    return number;
}

inline std::optional<std::int64_t> whole_number(std::string_view word) {
    return number_in<std::int64_t>(word);
}

std::string lower_case(std::string text);

std::vector<std::string> words_of(const std::string& text);

std::string without_blanks(const std::string& text);

// A pattern of file names with a number in them, such as "slice%03d.raw".
struct FilePattern {
    std::string before, after;
    int width = 0;  // least number of digits; zeros go before shorter numbers
};

// Parses a pattern. Returns nothing unless it has exactly one %d, %3d or %03d, and no other '%'.
std::optional<FilePattern> file_pattern(std::string_view text);

constexpr std::int64_t most_pattern_files = 100000;

// Returns the names with the numbers from `first` to `last`. Returns nothing if the step is 0 or
// leads away from `last`, or if there are more than most_pattern_files.
std::optional<std::vector<std::string>> names_of(const FilePattern& pattern, std::int64_t first,
                                                 std::int64_t last, std::int64_t step);

// Returns the regular files in a folder, except hidden ones, in the order of the numbers in their
// names: a2 before a10. Returns none if the folder cannot be read.
std::vector<std::filesystem::path> files_in_folder(const std::filesystem::path& folder);

// Returns those of these files that `is_known` accepts; of a path that is no folder, itself.
std::vector<std::filesystem::path> known_files_in(const std::filesystem::path& path,
                                                  bool (*is_known)(const std::filesystem::path&));

// Returns "3, 7 to 9": the numbers between those of an increasing series that are no steps of it.
std::string gaps_of(const std::vector<std::int64_t>& numbers);

// Checks that files, in the order of files_in_folder(), are one series whose names differ in one
// number. Warns of numbers that are missing between the first and the last, and of names without
// numbers, and of files in the folder that are no `kind` ("TIFF"). Throws Error if there are
// several series, or if two numbers change. `name`: the folder.
void warn_of_series(const std::string& name, const char* kind,
                    const std::vector<std::filesystem::path>& files);

}  // namespace lamina
